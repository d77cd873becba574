#include "tests/support/solids/hierarchy_score.h"

#include <fmt/core.h>

#include <map>

#include "mesher/geometry/mesh_checks.h"

namespace liana {
namespace {

/// Middle and area of a surface; equal ones are the same surface but for rounding.
struct Print {
  Vec3 middle = Vec3::Zero();
  double area = 0;
};

Print print_of(const Mesh& mesh) {
  Print print;
  for (const Triangle& t : mesh.triangles) {
    const double a = area_vector(mesh, t).norm();
    print.middle += a / 3 * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    print.area += a;
  }
  print.middle /= print.area;
  return print;
}

}  // namespace

HierarchyScore score(const SegmentedPlant& truth, const SegmentedPlant& found) {
  std::multimap<double, size_t> by_area;
  std::vector<Print> prints;
  for (const Domain& d : found.domains) {
    prints.push_back(print_of(d.surface));
    by_area.emplace(prints.back().area, prints.size() - 1);
  }
  std::vector<int> match(truth.domains.size(), -1), truth_of(found.domains.size(), -1);
  HierarchyScore result;
  result.domains = truth.domains.size();
  for (size_t i = 0; i < truth.domains.size(); ++i) {
    const Print p = print_of(truth.domains[i].surface);
    for (auto at = by_area.lower_bound(p.area * 0.999); at != by_area.end() && at->first <= p.area * 1.001;
         ++at) {
      const size_t f = at->second;
      if (truth_of[f] >= 0 || (prints[f].middle - p.middle).squaredNorm() > 1e-6 * p.area) continue;
      if (found.domains[f].kind != truth.domains[i].kind) continue;
      match[i] = static_cast<int>(f), truth_of[f] = static_cast<int>(i);
      break;
    }
    result.found += match[i] >= 0;
  }
  for (size_t i = 0; i < truth.domains.size(); ++i) {
    const DomainId parent = truth.domains[i].parent;
    std::string got = "not found";
    if (match[i] >= 0) {
      const Domain& domain = found.domains[match[i]];
      const int as = domain.parent.valid() ? truth_of[domain.parent.index()] : -1;
      if (parent.valid() ? as == static_cast<int>(parent.index()) : !domain.parent.valid()) {
        ++result.right;
        continue;
      }
      got = fmt::format("on {} with confidence {:.2f}",
                        !domain.parent.valid() ? "the ground"
                        : as < 0               ? "an unknown"
                                               : truth.domains[as].name,
                        domain.parent_confidence);
    }
    if (result.wrong.size() < 10)
      result.wrong.push_back(fmt::format("{} (on {}): {}", truth.domains[i].name,
                                         parent.valid() ? truth.domains[parent.index()].name : "the ground",
                                         got));
  }
  return result;
}

std::string merged_obj(const SegmentedPlant& plant, bool materials, double scale) {
  std::string text = "o plant\n";
  size_t first = 1;
  for (const Domain& domain : plant.domains) {
    if (materials) text += domain.kind == DomainKind::Leaf ? "usemtl leaf\n" : "usemtl bark\n";
    for (const Vec3& p : domain.surface.positions)
      text += fmt::format("v {:.7g} {:.7g} {:.7g}\n", scale * p.x(), scale * p.y(), scale * p.z());
    for (const Triangle& t : domain.surface.triangles)
      text += fmt::format("f {} {} {}\n", first + t[0], first + t[1], first + t[2]);
    first += domain.surface.positions.size();
  }
  return text;
}

}  // namespace liana
