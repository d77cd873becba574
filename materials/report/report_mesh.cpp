#include "materials/report/report_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "mesher/base/base64.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr double kLargest = 65535;

struct Box {
  Vec3 least = Vec3::Constant(std::numeric_limits<double>::infinity()), most = -least;
};

Box bounds(const SegmentedPlant& plant) {
  Box box;
  for (const Domain& domain : plant.domains)
    for (const Vec3& p : domain.surface.positions)
      box.least = box.least.cwiseMin(p), box.most = box.most.cwiseMax(p);
  return box;
}

template <class Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number),
               sizeof number);  // little-endian, as byte_stream.h checks
}

}  // namespace

ReportMesh report_mesh(const SegmentedPlant& plant, const std::vector<DomainId>& baked_as) {
  require(baked_as.size() == plant.domains.size(), "every domain is baked as something or nothing");
  const Box box = bounds(plant);
  const double step = std::max((box.most - box.least).maxCoeff(), 1e-6) / kLargest;
  size_t most_vertices = 0;
  for (const Domain& domain : plant.domains)
    most_vertices = std::max(most_vertices, domain.surface.positions.size());
  const bool wide = most_vertices > kLargest;

  ReportMesh result{box.least, step, {}, {}, wide ? 4 : 2, {}, {}};
  std::string positions, triangles;
  std::map<std::vector<Triangle>, size_t> known;
  size_t count = 0;
  for (size_t index = 0; index < plant.domains.size(); ++index) {
    const Mesh& mesh = plant.domains[index].surface;
    for (const Vec3& p : mesh.positions)
      for (int axis = 0; axis < 3; ++axis)
        append(positions, static_cast<uint16_t>(
                              std::lround(std::clamp((p[axis] - box.least[axis]) / step, 0.0, kLargest))));
    const auto [shape, is_new] = known.emplace(mesh.triangles, result.shapes.size());
    if (is_new) {
      result.shapes.push_back({count, mesh.triangles.size()});
      count += mesh.triangles.size();
      for (const Triangle& triangle : mesh.triangles)
        for (const uint32_t vertex : triangle)
          wide ? append(triangles, vertex) : append(triangles, static_cast<uint16_t>(vertex));
    }
    const DomainId id = baked_as[index];
    result.pieces.push_back(
        {id.valid() ? static_cast<int64_t>(id.value) : -1, mesh.positions.size(), shape->second});
  }
  result.positions = base64(positions);
  result.triangles = base64(triangles);
  return result;
}

}  // namespace liana
