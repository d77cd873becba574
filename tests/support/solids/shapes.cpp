#include "tests/support/solids/shapes.h"

#include <algorithm>
#include <cmath>

namespace liana {
namespace {

/// Point and frame of the arc y' = tangent, bending towards +x: x is the in-plane normal, z stays z.
Affine3 frame_on_arc(double s, const TubeShape& shape) {
  Affine3 frame = Affine3::Identity();
  const double angle = shape.bend * s / shape.length;
  if (std::abs(shape.bend) < 1e-12) {
    frame.translation() = Vec3(0, s, 0);
  } else {
    const double radius = shape.length / shape.bend;
    frame.translation() = Vec3(radius * (1 - std::cos(angle)), radius * std::sin(angle), 0);
  }
  frame.linear() = Eigen::AngleAxisd(-angle, Vec3::UnitZ()).toRotationMatrix();
  return frame;
}

}  // namespace

std::vector<double> graded_stations(double length, double diameter) {
  const double largest = length / 6;
  std::vector<double> stations{0};
  for (double step = diameter / 2; step < largest; step *= 2) stations.push_back(stations.back() + step);
  while (stations.size() > 1 && stations.back() > length - largest / 2) stations.pop_back();
  const double start = stations.back();
  const int steps = std::max(1, static_cast<int>(std::ceil((length - start) / largest - 1e-9)));
  for (int i = 1; i <= steps; ++i) stations.push_back(start + (length - start) * i / steps);
  return stations;
}

MarkedMesh make_tube(const TubeShape& shape) {
  const std::vector<double> stations =
      shape.stations.empty() ? graded_stations(shape.length, shape.diameter) : shape.stations;
  const auto n = static_cast<uint32_t>(shape.sides);
  const auto rings = static_cast<uint32_t>(stations.size());
  MarkedMesh tube;
  Mesh& mesh = tube.mesh;
  for (const double s : stations) {
    const double radius = shape.diameter / 2 * (1 + (shape.tip_scale - 1) * s / shape.length);
    const Affine3 frame = frame_on_arc(s, shape);
    for (uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * kPi * i / n;
      mesh.positions.push_back(frame * Vec3(radius * std::cos(angle), 0, radius * std::sin(angle)));
    }
  }
  for (uint32_t r = 0; r + 1 < rings; ++r) {
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = r * n + i, b = r * n + (i + 1) % n;
      mesh.triangles.push_back({a, a + n, b});
      mesh.triangles.push_back({b, a + n, b + n});
    }
  }
  tube.is_root.assign(mesh.triangles.size(), 0);
  const auto cap = [&](uint32_t ring, bool is_root) {
    const auto centre = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(frame_on_arc(stations[ring], shape).translation());
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = ring * n + i, b = ring * n + (i + 1) % n;
      mesh.triangles.push_back(is_root ? Triangle{centre, a, b} : Triangle{centre, b, a});
      tube.is_root.push_back(is_root);
    }
  };
  if (shape.root_cap) cap(0, true);
  if (shape.tip_cap) cap(rings - 1, false);
  return tube;
}

MarkedMesh make_prism(int sides, double length, double diameter) {
  return make_tube({.sides = sides, .length = length, .diameter = diameter, .stations = {}});
}

double polygon_area(int sides, double diameter) {
  const double r = diameter / 2;
  return sides * r * r * std::sin(2 * kPi / sides) / 2;
}

double polygon_second_moment(int sides, double diameter) {
  const double r = diameter / 2, angle = 2 * kPi / sides;
  return sides * std::pow(r, 4) * std::sin(angle) * (2 + std::cos(angle)) / 24;
}

Mesh make_leaf_card(const LeafCard& shape) {
  Mesh mesh;
  const auto columns = static_cast<uint32_t>(shape.across + 1);
  const TubeShape spine{.length = shape.length, .bend = shape.bend, .stations = {}};
  for (int j = 0; j <= shape.along; ++j) {
    const double s = double(j) / shape.along;
    // A blade from 15 % of its width at the petiole over the full width at 40 % to 10 % at the tip.
    const double outline = !shape.pointed ? 1
                           : s < 0.4      ? 0.15 + 0.85 * std::sin(kPi / 2 * s / 0.4)
                                          : 0.1 + 0.9 * std::cos(kPi / 2 * (s - 0.4) / 0.6);
    const Affine3 frame = Eigen::AngleAxisd(-kPi / 2, Vec3::UnitY()) * frame_on_arc(s * shape.length, spine);
    for (int i = 0; i <= shape.across; ++i) {
      const double u = (double(i) / shape.across - 0.5) * shape.width * outline;
      // In the arc's frame the sheet lies in the tangent (y) and z; turned by -90° about y that is y and x.
      mesh.positions.push_back(frame *
                               Vec3(std::abs(u) * std::sin(shape.fold), 0, -u * std::cos(shape.fold)));
    }
  }
  for (uint32_t j = 0; j < static_cast<uint32_t>(shape.along); ++j) {
    for (uint32_t i = 0; i + 1 < columns; ++i) {
      const uint32_t a = j * columns + i;
      mesh.triangles.push_back({a, a + 1, a + columns});
      mesh.triangles.push_back({a + 1, a + columns + 1, a + columns});
    }
  }
  return mesh;
}

Mesh make_box(const Vec3& corner, const Vec3& size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(corner + size.cwiseProduct(Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh transformed(const Mesh& mesh, const Affine3& transform) {
  Mesh result = mesh;
  for (Vec3& p : result.positions) p = transform * p;
  if (transform.linear().determinant() < 0)
    for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
  return result;
}

SegmentedPlant make_small_plant() {
  SegmentedPlant plant;
  plant.name = "small plant";
  const auto add = [&](std::string name, DomainId parent, DomainKind kind, const Mesh& mesh,
                       const Affine3& place) {
    Domain domain;
    domain.name = std::move(name);
    domain.parent = parent;
    domain.kind = kind;
    domain.level = parent.valid() ? plant.domains[parent.index()].level + 1 : 0;
    domain.group = kind == DomainKind::Leaf ? "leaf" : "level" + std::to_string(domain.level);
    domain.surface = transformed(mesh, place);
    plant.domains.push_back(std::move(domain));
    return DomainId(plant.domains.size() - 1);
  };
  const auto open_tube = [](double length, double diameter) {
    return make_tube({.sides = 8,
                      .length = length,
                      .diameter = diameter,
                      .tip_scale = 0.5,
                      .bend = 0.3,
                      .stations = {0, length / 4, length / 2, length * 3 / 4, length},
                      .root_cap = false,
                      .tip_cap = false})
        .mesh;
  };
  const auto placed = [](const Vec3& at, double azimuth, double tilt) {
    return Affine3(Eigen::Translation3d(at) * Eigen::AngleAxisd(azimuth, Vec3::UnitY()) *
                   Eigen::AngleAxisd(tilt, Vec3::UnitX()));
  };
  // The trunk's arc, for the attachment points of its branches.
  const TubeShape trunk_axis{.length = 1.2, .bend = 0.3, .stations = {}};
  const DomainId trunk =
      add("trunk", {}, DomainKind::Branch, open_tube(trunk_axis.length, 0.06), Affine3::Identity());
  for (int i = 0; i < 3; ++i) {
    const std::string number = std::to_string(i + 1);
    const Vec3 at = frame_on_arc(0.6 + 0.2 * i, trunk_axis).translation();
    const Affine3 branch_place = placed(at, 2.1 * i, 1.0);
    const TubeShape branch_axis{.length = 0.5, .bend = 0.3, .stations = {}};
    const DomainId branch =
        add("branch" + number, trunk, DomainKind::Branch, open_tube(branch_axis.length, 0.02), branch_place);
    const Affine3 twig_place = branch_place * placed(frame_on_arc(0.3, branch_axis).translation(), 1.0, 0.9);
    const TubeShape twig_axis{.length = 0.2, .bend = 0.3, .stations = {}};
    const DomainId twig =
        add("twig" + number, branch, DomainKind::Branch, open_tube(twig_axis.length, 0.006), twig_place);
    for (int k = 0; k < 2; ++k) {
      const Affine3 leaf_place =
          twig_place * placed(frame_on_arc(0.1 + 0.08 * k, twig_axis).translation(), 1.5 + 3 * k, 0.8);
      add("leaf" + number + "." + std::to_string(k + 1), twig, DomainKind::Leaf, make_leaf_card({}),
          leaf_place);
    }
  }
  return plant;
}

}  // namespace liana
