#include "tests/support/plants/synthetic_bake.h"

#include <algorithm>
#include <cmath>

#include "runtime/sim/model/rod_section.h"

namespace liana::test {
namespace {

DomainMaterial material(double frequency, double damping_factor) {
  const double omega = 2 * kPi * frequency;
  return {frequency, 1, damping_factor, damping_factor * omega, damping_factor / omega};  // ξ half and half
}

BakedDomain domain(const std::string& name, DomainId parent, int level, const Vec3& root, const Vec3& along,
                   double length, double radius, const TreeShape& shape) {
  BakedDomain d;
  d.name = name;
  d.parent = parent;
  d.level = level;
  d.group = "level" + std::to_string(level);
  d.length = length;
  const Vec3 side = along.unitOrthogonal();
  constexpr int kStations = 9;
  for (int i = 0; i < kStations; ++i) {
    const double t = i / (kStations - 1.0), r = radius * (1 - 0.8 * t);
    d.centreline.push_back({root + length * (t * along + 0.06 * std::sin(3 * t) * side), r, r});
  }
  d.density = 745;
  d.youngs_modulus = 8.77e9;
  d.mass = d.density * kPi * radius * radius * length * (1 - 0.8 + 0.64 / 3);
  d.flat_normal = side;
  const double frequency = shape.trunk_frequency * std::pow(length / shape.height, -0.59);
  const double t = std::clamp((frequency - 1) / 2, 0.0, 1.0);
  d.material = material(frequency, shape.damping_low + t * (shape.damping_high - shape.damping_low));
  return d;
}

Vec3 point_on(const BakedDomain& d, double t) {
  const double s = t * static_cast<double>(d.centreline.size() - 1);
  const size_t i = std::min(static_cast<size_t>(s), d.centreline.size() - 2);
  return d.centreline[i].position +
         (s - static_cast<double>(i)) * (d.centreline[i + 1].position - d.centreline[i].position);
}

void make_leaf(BakedDomain& d) {
  d.kind = DomainKind::Leaf;
  d.group = "leaf";
  for (Station& s : d.centreline) s.half_width = 0.25 * d.length, s.half_thickness = 1.5e-4;
  d.mass = d.density * d.length * 0.5 * d.length * 3e-4;
  d.stiffness_ratio = 400;
}

}  // namespace

Bake synthetic_bake(const TreeShape& shape) {
  Bake bake;
  bake.plant = "synthetic";
  bake.law.species = "synthetic";
  const auto add = [&](BakedDomain d) {
    d.solved_as = DomainId(bake.domains.size());
    bake.domains.push_back(std::move(d));
    return DomainId(bake.domains.size() - 1);
  };
  const double golden = 2.399963;  // rad, the angle between successive organs
  double turn = 0;
  const auto outwards = [&](double rise) {
    turn += golden;
    return Vec3(std::cos(turn), rise, std::sin(turn)).normalized();
  };
  const DomainId trunk =
      add(domain("trunk", {}, 0, Vec3::Zero(), Vec3::UnitY(), shape.height, 0.018 * shape.height, shape));
  for (int b = 0; b < shape.branches; ++b) {
    const double t = 0.35 + 0.6 * (b + 0.5) / shape.branches;
    const double length = 0.45 * shape.height * (1.1 - 0.6 * t);
    const DomainId branch =
        add(domain("branch" + std::to_string(b), trunk, 1, point_on(bake.domains[trunk.index()], t),
                   outwards(0.7), length, 0.012 * length, shape));
    for (int w = 0; w < shape.twigs; ++w) {
      const double at = 0.3 + 0.65 * (w + 0.5) / shape.twigs;
      const DomainId twig =
          add(domain("twig" + std::to_string(w), branch, 2, point_on(bake.domains[branch.index()], at),
                     outwards(0.4), 0.35 * length, 0.003 * length, shape));
      for (int l = 0; l < shape.leaves; ++l) {
        BakedDomain leaf = domain("leaf" + std::to_string(l), twig, 3,
                                  point_on(bake.domains[twig.index()], 0.6 + 0.4 * l / shape.leaves),
                                  outwards(0.1), 0.06, 0.01, shape);
        make_leaf(leaf);
        add(std::move(leaf));
      }
    }
  }
  return bake;
}

Bake rod_bake(const RodShape& rod) {
  Bake bake;
  bake.plant = "rod";
  BakedDomain d;
  d.name = "rod";
  d.group = "level0";
  d.length = rod.length;
  d.mass = rod.density * kPi * rod.radius * rod.radius / rod.flatness * rod.length;
  d.youngs_modulus = rod.youngs_modulus;
  d.density = rod.density;
  d.stiffness_ratio = rod.flatness * rod.flatness;
  d.material = material(rod.frequency, rod.damping_factor);
  d.solved_as = DomainId(0);
  for (int i = 0; i < 2; ++i)
    d.centreline.push_back({Vec3(0, i * rod.length, 0), rod.radius, rod.radius / rod.flatness});
  bake.domains.push_back(std::move(d));
  return bake;
}

Plant rod_plant(const RodShape& rod, int n) {
  Plant plant;
  plant.name = "rod";
  Branch branch;
  branch.group = "level0";
  branch.length = rod.length;
  branch.material = material(rod.frequency, rod.damping_factor);
  const double half = rod.length / n / 2, a = rod.radius, b = rod.radius / rod.flatness;
  const RodSection section = rod_section(rod.youngs_modulus, 0.3, a, b, rod.flatness * rod.flatness);
  for (int i = 0; i < n; ++i) {
    Particle p;
    p.branch = BranchId(0);
    if (i > 0) p.parent = ParticleId(static_cast<size_t>(i) - 1);
    p.half_length = half;
    p.half_width = a;
    p.half_thickness = b;
    p.mass = rod.density * kPi * a * b * 2 * half;
    p.inertia = rod_inertia(p.mass, half, a, b);
    p.joint.on_parent = i > 0 ? Vec3(0, half, 0) : Vec3::Zero();
    p.joint.on_self = {0, -half, 0};
    set_section(p.joint, section, i > 0 ? 2 * half : half);
    branch.particles.push_back(ParticleId(static_cast<size_t>(i)));
    plant.particles.push_back(p);
    plant.motion.push_back({.position = {0, (2 * i + 1) * half, 0}});
  }
  plant.branches.push_back(std::move(branch));
  return plant;
}

}  // namespace liana::test
