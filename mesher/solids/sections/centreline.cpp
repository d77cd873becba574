#include "mesher/solids/sections/centreline.h"

#include <algorithm>
#include <cmath>

#include "mesher/solids/sections/slice.h"

namespace liana {
namespace {

/// Half axes a >= b of the ellipse with these second moments: π a³b/4 and π ab³/4.
void set_half_axes(const PolygonMoments& moments, Section& section) {
  const double wide = 4 / kPi * moments.along_wide, thin = 4 / kPi * moments.along_thin;
  section.half_width = std::pow(wide * wide * wide / thin, 0.125);
  section.half_thickness = std::pow(thin * thin * thin / wide, 0.125);
}

/// The middle of the largest contour at a distance from the root.
Vec3 contour_middle(const MarkedSurface& solid, double level) {
  std::vector<double> value(solid.distance);
  for (double& v : value) v -= level;
  PolygonMoments largest;
  for (const std::vector<Vec3>& contour : zero_contours(solid.mesh, value)) {
    const PolygonMoments moments = polygon_moments(contour);
    if (moments.area > largest.area) largest = moments;
  }
  return largest.centroid;
}

/// The cut of the plane through `centre` across `tangent`: of several pieces the one around the centre.
PolygonMoments plane_cut(const Mesh& mesh, const Vec3& centre, const Vec3& tangent) {
  std::vector<double> value;
  value.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) value.push_back((p - centre).dot(tangent));
  PolygonMoments nearest;
  for (const std::vector<Vec3>& contour : zero_contours(mesh, value)) {
    const PolygonMoments moments = polygon_moments(contour);
    if (moments.area > 0 &&
        (nearest.area == 0 || (moments.centroid - centre).norm() < (nearest.centroid - centre).norm()))
      nearest = moments;
  }
  return nearest;
}

/// Thin axes across the line; where a section is round (no axis of its own), the neighbour's carried along.
void align_thin_axes(std::vector<Section>& line) {
  const auto is_round = [](const Section& s) { return s.half_width < 1.05 * s.half_thickness; };
  size_t flattest = 0;
  for (size_t i = 0; i < line.size(); ++i)
    if (line[i].half_width / line[i].half_thickness >
        line[flattest].half_width / line[flattest].half_thickness)
      flattest = i;
  const auto settle = [&](size_t i, size_t before) {
    const Vec3 tangent =
        (line[std::min(i + 1, line.size() - 1)].centre - line[i ? i - 1 : 0].centre).normalized();
    Vec3 axis = is_round(line[i]) ? line[before].thin_axis : line[i].thin_axis;
    if (axis.dot(line[before].thin_axis) < 0) axis = -axis;
    axis -= axis.dot(tangent) * tangent;
    line[i].thin_axis = axis.norm() > 1e-6 ? Vec3(axis.normalized()) : tangent.unitOrthogonal();
  };
  settle(flattest, flattest);
  for (size_t i = flattest + 1; i < line.size(); ++i) settle(i, i - 1);
  for (size_t i = flattest; i-- > 0;) settle(i, i + 1);
}

}  // namespace

std::vector<Section> find_centreline(const MarkedSurface& solid, const Vec3& root, double length,
                                     double diameter) {
  const int count = static_cast<int>(std::lround(std::clamp(length / diameter, 8., 24.)));
  std::vector<Vec3> centre{root};
  for (int i = 1; i < count - 1; ++i) centre.push_back(contour_middle(solid, length * i / (count - 1)));
  // The contours at the very tip are shreds of its rim: go on straight from the last two.
  centre.push_back(2 * centre[count - 2] - centre[count - 3]);

  std::vector<Section> line(count);
  for (int i = 0; i < count; ++i) {
    const int from = std::max(i - 1, 0), to = std::min(i + 1, count - 1);
    line[i].centre = centre[i];
    // The first and last cuts are moved inside, where an oblique end cannot clip them.
    Vec3 at = centre[i];
    if (i == 0) at = centre[0] + 0.5 * (centre[1] - centre[0]);
    if (i == count - 1) at = centre[i] + 0.5 * (centre[i - 1] - centre[i]);
    const PolygonMoments cut = plane_cut(solid.mesh, at, (centre[to] - centre[from]).normalized());
    if (cut.area > 0 && cut.along_thin > 0) {
      set_half_axes(cut, line[i]);
      line[i].area = cut.area;
      line[i].thin_axis = cut.thin;
    } else if (i > 0) {
      const Vec3 own = line[i].centre;
      line[i] = line[i - 1];
      line[i].centre = own;
    } else {
      line[i].half_width = line[i].half_thickness = diameter / 2;
      line[i].thin_axis = (centre[to] - centre[from]).unitOrthogonal();
    }
  }
  align_thin_axes(line);
  return line;
}

}  // namespace liana
