#include "runtime/growth/leaves.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/random.h"
#include "runtime/growth/segments.h"
#include "runtime/growth/tropisms.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/model/rotation.h"

namespace liana {
namespace {

constexpr double kClear = 2e-3;      // m, that a new leaf keeps from solids
constexpr double kYoungest = 0.2;    // size of a leaf when it unfolds, of its full size
constexpr double kClearance = 2e-3;  // m that a growing blade keeps from solids

/// Local +Y along the midrib, +Z (the upper side) as near to `face` as that allows.
Quat leaf_frame(const Vec3& midrib, const Vec3& face) {
  Mat3 axes;
  axes.col(1) = midrib.normalized();
  const Vec3 across = axes.col(1).cross(face);
  axes.col(0) = across.norm() > 1e-6 ? across.normalized() : axes.col(1).unitOrthogonal();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return Quat(axes);
}

/// A direction (unit) for what reaches out from `base` by `length` (m), turned from where it would be in a
/// solid. Nearer places turn it first: further in, the nearest way out may be the one on the other side.
Vec3 out_of_solids(const Vec3& base, Vec3 direction, double length, const Surroundings& around) {
  constexpr int kPlaces = 4;
  for (int i = 1; i <= kPlaces; ++i) {
    const Vec3 way = length * i / kPlaces * direction;
    direction = (way + way_out(base + way, kClear, around)).normalized();
  }
  return direction;
}

}  // namespace

BranchId Leaves::sprout(Plant& plant, Shoot& shoot, ParticleId node, const Vec3& outward,
                        const Surroundings& around, const SpeciesLaw& law, uint64_t seed) {
  const LeafParameters& p = parameters_;
  const LineageId lineage = child_lineage(plant.lineage_of(node), LineageKind::Leaf, 0);  // one a node
  const Draws draws(seed, lineage, "growth/leaf");
  const Vec3 forward = forward_of(plant, node);
  Vec3 side = outward.cross(forward);
  side = side.norm() > 1e-6 ? side.normalized() : forward.unitOrthogonal();
  side = rotation_about(forward, p.divergence * shoot.leaves++) * side;
  const Vec3 vary = p.variation * Vec3(draws.normal(0), draws.normal(1), draws.normal(2));
  // Sideways from the stem, away from the wall, the tip hanging a little.
  Vec3 midrib = side + 0.35 * forward + vary;
  const double away = midrib.dot(outward);
  midrib += (std::max(away, 0.75) - away) * outward - 0.35 * Vec3::UnitY();
  const double height = head_of(plant, node).y() - around.ground_height;
  if (height < p.petiole + p.length) midrib.y() = std::max(midrib.y(), 0.3 * midrib.norm());

  const double size = 1 + p.variation * draws.uniform(3, -1, 1);
  midrib = out_of_solids(head_of(plant, node), midrib.normalized(), p.petiole + size * p.length, around);
  Leaf leaf{BranchId(plant.branches.size()), size * p.length, size * p.width, outward};
  Branch branch;
  branch.parent = shoot.branch;
  branch.kind = DomainKind::Leaf;
  branch.level = plant.branches[shoot.branch.index()].level + 1;
  branch.group = "leaf";
  branch.lineage = lineage;
  plant.branches.push_back(branch);
  const SegmentShape shape{kYoungest * leaf.full_length / 2, kYoungest * leaf.full_width / 2, p.thickness / 2,
                           kYoungest * p.petiole};
  const Attachment at{node, Vec3(0, plant.particles[node.index()].half_length, 0)};
  const ParticleId blade = append_segment(plant, leaf.branch, at, shape, leaf_frame(midrib, outward));

  const ElasticMaterial& material = law.default_material;
  set_section(
      plant.particles[blade.index()].joint,
      rod_section(material.youngs_modulus, material.poisson_ratio, p.petiole_radius, p.petiole_radius, 1),
      p.petiole);
  leaves_.push_back(leaf);
  resize(plant, leaf, kYoungest, law);
  return leaf.branch;
}

void Leaves::resize(Plant& plant, const Leaf& leaf, double size, const SpeciesLaw& law) const {
  Branch& branch = plant.branches[leaf.branch.index()];
  const ParticleId id = branch.particles.front();
  Particle& blade = plant.particles[id.index()];
  const Vec3 joint = joint_point_of(plant, id);
  blade.half_length = size * leaf.full_length / 2;
  blade.half_width = size * leaf.full_width / 2;
  blade.joint.on_self = {0, -blade.half_length - size * parameters_.petiole, 0};
  Motion& motion = plant.motion[id.index()];
  motion.position = joint - motion.orientation * blade.joint.on_self;
  branch.length = size * (leaf.full_length + parameters_.petiole);
  branch.material = evaluate(law.group(branch.group), branch.length);
  set_mass(blade, DomainKind::Leaf, law.default_material.density * branch.material.mass_scaling);
}

void Leaves::grow(Plant& plant, const Surroundings& around, double dt, const SpeciesLaw& law) {
  const double full = parameters_.seconds_to_full;
  for (size_t i = first_growing_; i < leaves_.size(); ++i) {
    Leaf& leaf = leaves_[i];
    leaf.age += dt;
    const double t = std::min(1.0, leaf.age / full);
    const ParticleId blade = plant.branches[leaf.branch.index()].particles.front();
    const Vec3 face = plant.motion[blade.index()].orientation * Vec3::UnitZ();
    // To the light, but not into the wall.
    const Vec3 bright = (around.to_sun + leaf.outward).stableNormalized();
    turn_segment(plant, blade, phototropism(face, bright, 0, parameters_.phototropism * dt));
    resize(plant, leaf, kYoungest + (1 - kYoungest) * t * t * (3 - 2 * t), law);
    // A blade that grows against a wall turns away from it.
    const Particle& shape = plant.particles[blade.index()];
    for (const Vec3& point :
         {Vec3(shape.half_width, 0, 0), Vec3(-shape.half_width, 0, 0), Vec3(0, shape.half_length, 0)})
      keep_out(plant, blade, point, kClearance, around);
    if (t >= 1 && i == first_growing_) ++first_growing_;
  }
}

void Leaves::follow(const Remap& remap) {
  size_t kept = 0, kept_grown = 0;
  for (size_t i = 0; i < leaves_.size(); ++i) {
    leaves_[i].branch = remap(leaves_[i].branch);
    if (!leaves_[i].branch.valid()) continue;
    kept_grown += i < first_growing_;
    leaves_[kept++] = leaves_[i];
  }
  leaves_.resize(kept);
  first_growing_ = kept_grown;
}

void Leaves::mark_growing(const Plant& plant, std::vector<uint8_t>& growing) const {
  for (size_t i = first_growing_; i < leaves_.size(); ++i)
    if (leaves_[i].age < parameters_.seconds_to_full)
      for (const ParticleId id : plant.branches[leaves_[i].branch.index()].particles) growing[id.index()] = 1;
}

}  // namespace liana
