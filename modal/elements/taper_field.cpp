#include "modal/elements/taper_field.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/solids/solidify/geodesic.h"
#include "modal/elements/boundary_faces.h"

namespace liana {
namespace {

/// Vertices inside have no distance along the boundary: sweep by sweep, those next to known ones take the
/// mean of these.
void fill_inside(const TetMesh& mesh, std::vector<double>& distance) {
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<double> sum(distance.size(), 0);
    std::vector<int> count(distance.size(), 0);
    for (const auto& tet : mesh.tets)
      for (const uint32_t a : tet)
        for (const uint32_t b : tet)
          if (!std::isfinite(distance[a]) && std::isfinite(distance[b])) sum[a] += distance[b], ++count[a];
    for (size_t v = 0; v < distance.size(); ++v)
      if (count[v] > 0) distance[v] = sum[v] / count[v], changed = true;
  }
}

double six_volumes(const TetMesh& mesh, const std::array<uint32_t, 4>& tet) {
  const Vec3& origin = mesh.positions[tet[0]];
  return (mesh.positions[tet[1]] - origin)
      .cross(mesh.positions[tet[2]] - origin)
      .dot(mesh.positions[tet[3]] - origin);
}

}  // namespace

std::vector<ElementScaling> tapered(const TetMesh& mesh, const TaperLaw& law) {
  std::vector<uint8_t> is_root(mesh.positions.size(), 0);
  for (const auto& face : mesh.root_faces)
    for (const uint32_t v : face) is_root[v] = 1;
  if (mesh.root_faces.empty())
    throw Error(Error::Kind::Input, "no face is held: nothing to measure the taper from",
                "mark the faces nearest the parent as root");
  std::vector<double> distance = geodesic_distance({mesh.positions, boundary_faces(mesh)}, is_root);
  fill_inside(mesh, distance);
  double longest = 0;
  for (const double d : distance)
    if (std::isfinite(d)) longest = std::max(longest, d);

  std::vector<ElementScaling> scaling;
  scaling.reserve(mesh.tets.size());
  for (const auto& [a, b, c, d] : mesh.tets) {
    const double mean = (distance[a] + distance[b] + distance[c] + distance[d]) / 4;
    const double factor = taper_scaling(law, std::isfinite(mean) ? std::min(1.0, mean / longest) : 1.0);
    scaling.push_back({factor, factor});
  }
  return scaling;
}

double mean_density_scaling(const TetMesh& mesh, std::span<const ElementScaling> scaling) {
  double scaled = 0, volume = 0;
  for (size_t e = 0; e < mesh.tets.size(); ++e) {
    const double v = six_volumes(mesh, mesh.tets[e]);
    volume += v, scaled += v * scaling[e].density;
  }
  return scaled / volume;
}

}  // namespace liana
