#include "tests/support/plants/large_plants.h"

#include <cmath>

#include "mesher/base/random.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

constexpr uint32_t kSides = 6, kRings = 7;

/// An open tube with even rings.
Mesh open_tube(double length, double diameter, double tip_scale, double bend, int rings = kRings,
               int sides = kSides) {
  TubeShape shape{.sides = sides,
                  .length = length,
                  .diameter = diameter,
                  .tip_scale = tip_scale,
                  .bend = bend,
                  .stations = {}};
  for (int i = 0; i < rings; ++i) shape.stations.push_back(length * i / (rings - 1));
  shape.root_cap = shape.tip_cap = false;
  return make_tube(shape).mesh;
}

/// The middle of a ring, `fraction` of the way up.
Vec3 on_axis(const Mesh& tube, double fraction, uint32_t sides = kSides) {
  const size_t rings = tube.positions.size() / sides;
  const double at = fraction * static_cast<double>(rings - 1);
  const auto below = std::min(static_cast<size_t>(at), rings - 2);
  const auto middle = [&](size_t ring) {
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < sides; ++i) sum += tube.positions[ring * sides + i];
    return Vec3(sum / sides);
  };
  const double t = at - static_cast<double>(below);
  return (1 - t) * middle(below) + t * middle(below + 1);
}

Affine3 placed(const Vec3& at, double azimuth, double tilt) {
  return Affine3(Eigen::Translation3d(at) * Eigen::AngleAxisd(azimuth, Vec3::UnitY()) *
                 Eigen::AngleAxisd(tilt, Vec3::UnitX()));
}

constexpr double kGoldenAngle = 2.39996;  // rad

}  // namespace

InstancedPlant make_branch_hierarchy(int count, int children) {
  InstancedPlant plant;
  plant.name = "branches";
  Random random(1, "branch hierarchy");
  std::vector<double> lengths;
  for (int i = 0; i < count; ++i) {
    InstancedPlant::Part part;
    part.name = "branch" + std::to_string(i);
    part.mesh = plant.meshes.size();
    double length = 4;
    if (i > 0) {
      const int parent = (i - 1) / children, place = (i - 1) % children;
      part.parent = DomainId(static_cast<size_t>(parent));
      length = std::max(0.05, lengths[parent] * random.uniform(0.5, 0.8));
      const double fraction = 0.35 + 0.6 * (place + random.uniform(0, 0.9)) / children;
      part.place = plant.parts[parent].place * placed(on_axis(plant.meshes[parent], fraction),
                                                      kGoldenAngle * i, random.uniform(0.6, 1.1));
    }
    const double aspect = 10 * std::pow(10., random.uniform(0, 1));
    plant.meshes.push_back(
        open_tube(length, length / aspect, random.uniform(0.5, 0.9), random.uniform(0, 0.4)));
    plant.parts.push_back(std::move(part));
    lengths.push_back(length);
  }
  return plant;
}

InstancedPlant make_palm(int fronds, int leaflets) {
  InstancedPlant plant;
  plant.name = "palm";
  Random random(1, "palm");
  constexpr int kTrunkSides = 16;
  plant.meshes.push_back(open_tube(6, 0.3, 0.7, 0.1, 9, kTrunkSides));
  plant.meshes.push_back(make_leaf_card({.length = 0.5, .width = 0.03, .along = 9, .across = 3}));
  plant.parts.push_back({.name = "trunk", .parent = {}, .mesh = 0});
  for (int f = 0; f < fronds; ++f) {
    const double length = random.uniform(1.6, 2.6);
    const Vec3 top = on_axis(plant.meshes[0], 0.93 + 0.06 * f / fronds, kTrunkSides);
    plant.parts.push_back({.name = "frond" + std::to_string(f),
                           .parent = DomainId(size_t{0}),
                           .mesh = plant.meshes.size(),
                           .place = placed(top, kGoldenAngle * f, random.uniform(0.3, 1.4))});
    plant.meshes.push_back(open_tube(length, 0.03, 0.4, random.uniform(0.3, 1.0), 4));
  }
  for (int l = 0; l < leaflets; ++l) {
    const int frond = 1 + l % fronds;
    const InstancedPlant::Part& rachis = plant.parts[frond];
    const double along = 0.2 + 0.78 * (l / fronds + 0.5) / (leaflets / fronds + 1);
    const double size = (0.4 + 0.6 * std::sin(kPi * along)) * random.uniform(0.95, 1.05);
    const double side = l / fronds % 2 ? 1 : -1;
    const Vec3 base = on_axis(plant.meshes[rachis.mesh], along);
    plant.parts.push_back({.name = "leaflet" + std::to_string(l),
                           .parent = DomainId(static_cast<size_t>(frond)),
                           .kind = DomainKind::Leaf,
                           .thickness = 3e-4 * size,
                           .mesh = 1,
                           .place = rachis.place * placed(base, side * kPi / 2, random.uniform(0.7, 1.1)) *
                                    Eigen::Scaling(size)});
  }
  return plant;
}

SegmentedPlant flatten(const InstancedPlant& plant) {
  SegmentedPlant flat;
  flat.name = plant.name;
  for (const InstancedPlant::Part& part : plant.parts) {
    Domain domain;
    domain.name = part.name;
    domain.parent = part.parent;
    domain.kind = part.kind;
    domain.level = part.parent.valid() ? flat.domains[part.parent.index()].level + 1 : 0;
    domain.group = part.kind == DomainKind::Leaf ? "leaf" : "level" + std::to_string(domain.level);
    domain.thickness = part.thickness;
    domain.surface = transformed(plant.meshes[part.mesh], part.place);
    flat.domains.push_back(std::move(domain));
  }
  return flat;
}

}  // namespace liana
