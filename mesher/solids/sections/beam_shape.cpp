#include "mesher/solids/sections/beam_shape.h"

#include <algorithm>
#include <cmath>

#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/weld.h"
#include "mesher/solids/solidify/geodesic.h"

namespace liana {
namespace {

constexpr double kFlat = 0.05;  // thin over wide: flatter slices are sheets
constexpr double kOneStrand =
    2.6;  // outline over surface of the median slice: 1 a tube, 2.3 a strip's two sides

double largest_finite(const std::vector<double>& values, uint32_t* at) {
  double largest = 0;
  for (uint32_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i]) && values[i] > largest) largest = values[*at = i];
  return largest;
}

/// Distance along the surface from the root end: the mean of that from the root and that to the tip, whose
/// level lines lean opposite ways. Negative where the root cannot be reached. The length comes back.
double distance_along(const Mesh& mesh, const ParentSurface& support, std::vector<double>& along) {
  const auto from = [&](uint32_t v) {
    std::vector<uint8_t> source(mesh.positions.size(), 0);
    source[v] = 1;
    return geodesic_distance(mesh, source);
  };
  std::vector<uint32_t> all;
  for (const Triangle& t : mesh.triangles) all.insert(all.end(), t.begin(), t.end());
  uint32_t root = support.nearest(mesh, all), tip = root, opposite = root;
  std::vector<double> from_root = from(root);
  const double reach = largest_finite(from_root, &tip);
  const std::vector<double> from_tip = from(tip);
  const double length = largest_finite(from_tip, &opposite);
  if (from_root[opposite] < 0.3 * reach) from_root = from(root = opposite);
  along.assign(mesh.positions.size(), -1);
  for (size_t v = 0; v < along.size(); ++v)
    if (std::isfinite(from_root[v]))
      along[v] = std::clamp((from_root[v] + length - from_tip[v]) / 2, 0.0, length);
  return length;
}

struct Slice {
  double area = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

/// Area moments of the surface in slices of equal distance. Triangles are sampled finer than the slices.
std::vector<Slice> slices(const Mesh& mesh, const std::vector<double>& along, double length, int count) {
  std::vector<Slice> result(count);
  for (const Triangle& t : mesh.triangles) {
    if (along[t[0]] < 0) continue;
    double longest = 0;
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm());
    const int parts = static_cast<int>(std::clamp(4 * longest / length * count, 1., 100.));
    const double area = area_vector(mesh, t).norm() / parts / parts;
    for (int i = 0; i < parts; ++i)
      for (int j = 0; j < 2 * i + 1; ++j) {  // the small triangles of row i, upright and hanging
        const double up = j % 2 ? 2. / 3 : 1. / 3, a = (j / 2 + up) / parts,
                     b = (i - j / 2 - up + (j % 2 ? 1. / 3 : 2. / 3)) / parts, c = 1 - a - b;
        const Vec3 p = a * mesh.positions[t[0]] + b * mesh.positions[t[1]] + c * mesh.positions[t[2]];
        const double s = a * along[t[0]] + b * along[t[1]] + c * along[t[2]];
        Slice& slice = result[std::clamp(static_cast<int>(s / length * count), 0, count - 1)];
        slice.area += area, slice.first += area * p, slice.second += area * p * p.transpose();
      }
  }
  return result;
}

/// The section of a slice across `tangent`; half_width 0 if the slice is a line.
Section section_of(const Slice& slice, const Vec3& centre, const Vec3& tangent, double thickness) {
  const Vec3 u = tangent.unitOrthogonal(), v = tangent.cross(u), mean = slice.first / slice.area;
  const Mat3 spread = slice.second / slice.area - mean * mean.transpose();
  Eigen::Matrix2d across;
  across << u.dot(spread * u), u.dot(spread * v), v.dot(spread * u), v.dot(spread * v);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(across);
  const double thin = std::sqrt(std::max(0.0, axes.eigenvalues()[0])),
               wide = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  Section section;
  section.centre = centre;
  section.thin_axis = axes.eigenvectors()(0, 0) * u + axes.eigenvectors()(1, 0) * v;
  if (thin > kFlat * wide) {  // a wall around: of a circle of radius r the outline has mean square r²/2
    section.half_width = std::sqrt(2) * wide;
    section.half_thickness = std::sqrt(2) * thin;
    section.area = kPi * section.half_width * section.half_thickness;
  } else {  // a strip of width w has mean square w²/12
    const double width = std::sqrt(12) * wide,
                 same = std::pow(1 / (3 * kPi), 0.25);  // moments as the ellipse's
    section.half_width = same * width;
    section.half_thickness = same * thickness;
    section.area = width * thickness;
  }
  return section;
}

/// The end of the line: as far out as the surface goes around its last slice, linear from the two before it.
Section end_section(const Mesh& mesh, const Section& last, const Section& next, const Section& third) {
  const Vec3 outward = (next.centre - third.centre).normalized();
  const double reach = (last.centre - next.centre).norm() + 2 * next.half_width;
  double farthest = (last.centre - next.centre).dot(outward);
  for (const Vec3& p : mesh.positions)
    if ((p - last.centre).norm() < reach) farthest = std::max(farthest, (p - next.centre).dot(outward));
  const double spacing = (next.centre - third.centre).norm(), part = farthest / spacing;
  const auto carried_on = [&](double a, double b) { return std::max(a + part * (a - b), 0.2 * a); };
  Section end = next;
  end.centre = next.centre + farthest * outward;
  end.half_width = carried_on(next.half_width, third.half_width);
  end.half_thickness = carried_on(next.half_thickness, third.half_thickness);
  end.area = next.area * (end.half_width * end.half_thickness) / (next.half_width * next.half_thickness);
  return end;
}

/// The outlines of the sections account for the surface: a ring, or two branches side by side, have far less
/// surface in a slice than the outline around both; a doubled or crumpled one has more.
bool is_one_strand(const std::vector<Slice>& all, const std::vector<int>& used,
                   const std::vector<Section>& sections, double height) {
  std::vector<double> ratio;
  for (size_t i = 0; i < used.size(); ++i) {
    const double a = sections[i].half_width, b = sections[i].half_thickness;
    const double outline = kPi * (3 * (a + b) - std::sqrt((3 * a + b) * (a + 3 * b)));  // Ramanujan 1914
    ratio.push_back(outline * height / all[used[i]].area);
  }
  const auto middle = ratio.begin() + static_cast<ptrdiff_t>(ratio.size() / 2);
  std::nth_element(ratio.begin(), middle, ratio.end());
  return *middle < kOneStrand;
}

}  // namespace

std::optional<SolidDomain> beam_shape(const Domain& domain, const ParentSurface& support) {
  const Mesh mesh = weld(domain.surface);
  if (mesh.triangles.empty()) return {};
  std::vector<double> along;
  const double length = distance_along(mesh, support, along), area = surface_area(mesh);
  if (!(length > 0) || !std::isfinite(length) || !(area > 1e-9 * length * length)) return {};
  const int count = std::clamp(static_cast<int>(std::lround(kPi * length * length / area)), 8, 24);
  const std::vector<Slice> all = slices(mesh, along, length, count);

  // Slices that have any surface.
  std::vector<int> used;
  std::vector<Vec3> centre;
  for (int i = 0; i < count; ++i)
    if (all[i].area > 0) used.push_back(i), centre.push_back(all[i].first / all[i].area);
  const auto n = static_cast<int>(used.size());
  if (n < 5) return {};
  SolidDomain solid;
  int flat = 0;
  for (int i = 0; i < n; ++i) {
    const Vec3 tangent = (centre[std::min(i + 1, n - 1)] - centre[std::max(i - 1, 0)]).normalized();
    if (!(tangent.norm() > 0.5)) return {};
    const Section section = section_of(all[used[i]], centre[i], tangent, domain.thickness);
    flat += section.half_thickness < kFlat * section.half_width;
    if (!(section.half_thickness > 0) || !(section.half_width > 0)) return {};
    solid.centreline.push_back(section);
  }
  if (domain.kind == DomainKind::Branch && 2 * flat > n) return {};
  if (!is_one_strand(all, used, solid.centreline, length / count)) return {};
  // The slices at both ends hold lids: they end where the surface does, with the size of the others carried
  // on.
  const Section root = end_section(mesh, solid.centreline[0], solid.centreline[1], solid.centreline[2]);
  const Section tip =
      end_section(mesh, solid.centreline[n - 1], solid.centreline[n - 2], solid.centreline[n - 3]);
  solid.centreline.front() = root, solid.centreline.back() = tip;
  for (size_t i = 1; i < solid.centreline.size(); ++i) {
    const Section &a = solid.centreline[i - 1], &b = solid.centreline[i];
    solid.volume += (b.centre - a.centre).norm() * (a.area + b.area) / 2;
  }
  solid.surface = tube_through(solid.centreline);
  solid.is_root.assign(solid.surface.triangles.size(), 0);
  std::fill_n(solid.is_root.rbegin(), 8, uint8_t{1});
  solid.root = root.centre;
  solid.length = length;
  solid.is_beam = true;
  return solid;
}

Mesh tube_through(const std::vector<Section>& sections) {
  constexpr uint32_t kSides = 8;
  Mesh mesh;
  const auto n = static_cast<uint32_t>(sections.size());
  Vec3 thin = sections[0].thin_axis;
  for (uint32_t r = 0; r < n; ++r) {
    const Vec3 tangent =
        (sections[std::min(r + 1, n - 1)].centre - sections[r ? r - 1 : 0].centre).normalized();
    Vec3 axis = sections[r].thin_axis;
    if (axis.dot(thin) < 0) axis = -axis;
    thin = axis;
    const Vec3 wide = axis.cross(tangent);
    for (uint32_t i = 0; i < kSides; ++i) {
      const double angle = 2 * kPi * i / kSides;
      mesh.positions.push_back(sections[r].centre + sections[r].half_width * std::cos(angle) * wide +
                               sections[r].half_thickness * std::sin(angle) * axis);
    }
  }
  for (uint32_t r = 0; r + 1 < n; ++r)
    for (uint32_t i = 0; i < kSides; ++i) {
      const uint32_t a = r * kSides + i, b = r * kSides + (i + 1) % kSides;
      mesh.triangles.push_back({a, b, a + kSides});
      mesh.triangles.push_back({b, b + kSides, a + kSides});
    }
  for (const uint32_t ring : {n - 1, 0u}) {
    const auto middle = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(sections[ring].centre);
    for (uint32_t i = 0; i < kSides; ++i) {
      const uint32_t a = ring * kSides + i, b = ring * kSides + (i + 1) % kSides;
      mesh.triangles.push_back(ring ? Triangle{middle, a, b} : Triangle{middle, b, a});
    }
  }
  return mesh;
}

}  // namespace liana
