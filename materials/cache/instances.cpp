#include "materials/cache/instances.h"

#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "mesher/base/hash.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/solids/solidify/sheet.h"
#include "mesher/solids/solidify/support.h"

namespace liana {
namespace {

constexpr double kVertexTolerance = 2e-3;  // of the thickness, as for solids: see find_similarity()
/// Copies differ by less in any ratio of their distances.
constexpr double kWindow = 5e-3;
/// Of the thickness ratio of two sheets.
constexpr double kThicknessTolerance = 2e-3;

/// Numbers that copies share, to sort by.
struct Shape {
  uint64_t connectivity;
  std::array<double, 3> ratios;  // without unit
  double extent;                 // m, root mean square distance from the middle
  double tolerance;              // m
};

Shape shape_of(const Domain& domain) {
  const std::vector<Vec3>& points = domain.surface.positions;
  Shape shape;
  const uint64_t kinds[2] = {points.size(), uint64_t(domain.kind)};
  shape.connectivity = hash_span<Triangle>(domain.surface.triangles, hash_bytes(kinds, sizeof kinds));
  const Vec3 centre = mean_position(points);
  double variance = 0, volume = 0, area = 0;
  for (const Vec3& p : points) variance += (p - centre).squaredNorm();
  for (const auto& [a, b, c] : domain.surface.triangles) {
    const Vec3 p = points[a] - centre, q = points[b] - centre, r = points[c] - centre;
    volume += p.cross(q).dot(r) / 6;
    area += (q - p).cross(r - p).norm() / 2;
  }
  const double extent = shape.extent = std::sqrt(variance / static_cast<double>(points.size()));
  shape.ratios = {area / (extent * extent), (points.front() - centre).norm() / extent,
                  (points.back() - points.front()).norm() / extent};
  const double thickness = 2 * std::abs(volume) / area;
  shape.tolerance = kVertexTolerance * (domain.kind == DomainKind::Leaf ? domain.thickness : thickness);
  return shape;
}

bool is_open_sheet(const Domain& domain) {
  const std::vector<std::vector<uint32_t>> loops =
      border_loops(domain.surface, find_adjacency(domain.surface));
  return !loops.empty() && is_sheet(domain.surface, loops);
}

std::optional<Similarity> similarity_of(const Domain& from, const Domain& to, double tolerance) {
  const std::vector<Vec3>&a = from.surface.positions, &b = to.surface.positions;
  if (a.size() != b.size() || from.kind != to.kind || from.surface.triangles != to.surface.triangles)
    return {};
  const Similarity s = best_similarity(a, b);
  for (size_t i = 0; i < a.size(); ++i)
    if (!((s.point(a[i]) - b[i]).norm() <= tolerance)) return {};  // also for NaN
  return s;
}

/// The first of its shape.
struct Candidate {
  size_t domain;
  std::array<double, 3> ratios;
  double slimness;  // thickness over extent
  bool is_sheet;    // else the thickness does not matter

  bool may_match(const Domain& copy, const Shape& shape) const {
    if (is_sheet && std::abs(copy.thickness / shape.extent / slimness - 1) > kThicknessTolerance)
      return false;
    return std::abs(ratios[1] - shape.ratios[1]) <= kWindow * (1 + ratios[1]) &&
           std::abs(ratios[2] - shape.ratios[2]) <= kWindow * (1 + ratios[2]);
  }
};

}  // namespace

std::vector<Instance> find_instances(const SegmentedPlant& plant) {
  std::map<uint64_t, std::multimap<double, Candidate>> known;
  std::vector<Instance> instances;
  for (size_t i = 0; i < plant.domains.size(); ++i) {
    instances.push_back({i, {}});
    const Domain& domain = plant.domains[i];
    if (domain.surface.positions.empty()) continue;
    const Shape shape = shape_of(domain);
    if (!std::isfinite(shape.ratios[0] + shape.ratios[1] + shape.ratios[2])) continue;
    auto& candidates = known[shape.connectivity];
    const auto end = candidates.upper_bound(shape.ratios[0] * (1 + kWindow));
    for (auto c = candidates.lower_bound(shape.ratios[0] * (1 - kWindow)); c != end; ++c) {
      if (!c->second.may_match(domain, shape)) continue;
      if (const auto similarity = similarity_of(plant.domains[c->second.domain], domain, shape.tolerance)) {
        instances.back() = {c->second.domain, *similarity};
        break;
      }
    }
    if (instances.back().source == i)
      candidates.emplace(shape.ratios[0],
                         Candidate{i, shape.ratios, domain.thickness / shape.extent, is_open_sheet(domain)});
  }
  return instances;
}

bool attached_alike(const SegmentedPlant& plant, DomainId source, const SolidDomain& solid, DomainId copy,
                    const Similarity& similarity) {
  const auto nearest = [&](DomainId domain) {
    const Mesh& surface = plant.domains[domain.index()].surface;
    std::vector<uint32_t> all(surface.positions.size());
    std::iota(all.begin(), all.end(), 0u);
    return surface.positions[Support(plant, domain).nearest(surface, all)];
  };
  constexpr double kNear = 0.1;  // of the length: the other end and the sides lie further away
  const double own = (nearest(source) - solid.root).norm();
  return (similarity.inverse_point(nearest(copy)) - solid.root).norm() <= own + kNear * solid.length;
}

SolidDomain moved(const SolidDomain& solid, const Similarity& similarity) {
  SolidDomain copy = solid;
  for (Vec3& p : copy.surface.positions) p = similarity.point(p);
  copy.root = similarity.point(solid.root);
  copy.length *= similarity.scale;
  copy.volume *= std::pow(similarity.scale, 3);
  for (Section& section : copy.centreline) {
    section.centre = similarity.point(section.centre);
    section.half_width *= similarity.scale, section.half_thickness *= similarity.scale;
    section.area *= similarity.scale * similarity.scale;
    section.thin_axis = similarity.rotation * section.thin_axis;
  }
  return copy;
}

}  // namespace liana
