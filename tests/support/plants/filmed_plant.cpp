#include "tests/support/plants/filmed_plant.h"

#include <cmath>

namespace liana::test {
namespace {

BakedDomain rod(const std::string& name, DomainId parent, const Vec3& root, const Vec3& along, double length,
                double radius, double nu, double xi) {
  Bake straight = rod_bake({.length = length, .radius = radius, .frequency = nu, .damping_factor = xi});
  BakedDomain d = straight.domains.front();
  d.name = name;
  d.default_frequency = nu;
  d.parent = parent;
  d.level = parent.valid() ? 1 : 0;
  d.group = parent.valid() ? "level1" : "level0";
  const Vec3 way = along.normalized();
  d.centreline.clear();
  constexpr int kStations = 5;
  for (int i = 0; i < kStations; ++i) {
    const double t = i / (kStations - 1.0), r = radius * (1 - 0.5 * t);
    d.centreline.push_back({root + t * length * way, r, r});
  }
  // Branches of a tenth of wood's density, so that they do not pull at the trunk.
  if (parent.valid()) d.density *= 0.1;
  d.mass = d.density * kPi * radius * radius * length * (1 - 0.5 + 0.25 / 3);
  d.flat_normal = Vec3::UnitZ();
  return d;
}

}  // namespace

Bake filmed_plant() {
  Bake bake;
  bake.plant = "filmed";
  bake.law.species = "known";
  for (const double xi : {0.03, 0.05}) {
    GroupLaw& law = bake.law.groups[xi == 0.03 ? "level0" : "level1"];
    law.reference_frequency = xi == 0.03 ? 1.1 : 2.4;
    law.reference_length = xi == 0.03 ? 2 : 0.7;
    law.damping.low_factor = law.damping.high_factor = xi;
  }
  const auto branch_frequency = [](double length) { return 2.4 * std::pow(length / 0.7, -0.59); };
  bake.domains.push_back(rod("trunk", {}, Vec3::Zero(), Vec3::UnitY(), 2, 0.07, 1.1, 0.03));
  const auto branch = [&](const std::string& name, double height, const Vec3& along, double length) {
    bake.domains.push_back(
        rod(name, DomainId(0), {0, height, 0}, along, length, 0.022, branch_frequency(length), 0.05));
  };
  branch("left", 0.7, {-1, 0.6, 0}, 0.9);
  branch("right", 0.9, {1, 0.6, 0}, 0.7);
  branch("top", 1.3, {-0.7, 0.7, 0}, 0.55);
  for (size_t i = 0; i < bake.domains.size(); ++i) bake.domains[i].solved_as = DomainId(i);
  return bake;
}

}  // namespace liana::test
