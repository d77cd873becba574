#include "runtime/growth/shoots.h"

#include <algorithm>

#include "mesher/base/random.h"
#include "runtime/growth/branching.h"
#include "runtime/growth/growth_weights.h"
#include "runtime/growth/light.h"
#include "runtime/sim/model/rotation.h"

namespace liana {
namespace {

/// Away from the support; away from the stem's underside where there is none.
Vec3 outward_of(const std::optional<Support>& support, const Vec3& forward, const Vec3& to_sun) {
  const Vec3 away = support ? support->normal : to_sun;
  const Vec3 across = away - away.dot(forward) * forward;
  return across.norm() > 1e-3 ? across.normalized() : forward.unitOrthogonal();
}

}  // namespace

Shoots::Shoots(const ClimberParameters& parameters, const SpeciesLaw& law, const Vec3& seed,
               uint64_t random_seed)
    : parameters_(parameters),
      law_(law),
      seed_(seed),
      random_seed_(random_seed),
      leaves_(parameters.leaves),
      anchors_(parameters.anchors, parameters.tip_radius),
      crowding_(std::max(parameters.branching.room, 0.02)) {}

// Every first shoot stands in the ground by itself, beside the others, and leans towards the support in a
// fan.
void Shoots::germinate(Plant& plant, const Surroundings& around, Embodiment& body) {
  const auto support = closest_support(around.obstacles, seed_, parameters_.tropisms.search_radius);
  Vec3 to_support = support ? Vec3(-support->normal) : Vec3::Zero();
  to_support.y() = 0;
  const Vec3 up = Vec3::UnitY(), direction = (0.35 * up + to_support).normalized();
  const Vec3 normal = to_support.norm() > 1e-3 ? Vec3(-to_support.normalized()) : Vec3(Vec3::UnitZ());
  const int count = static_cast<int>(parameters_.first_shoots);
  for (int i = 0; i < count; ++i) {
    const double place = count > 1 ? 2.0 * i / (count - 1) - 1 : 0;  // -1 … 1
    const Shoot shoot{BranchId(), parameters_.tip_radius, place * parameters_.fan, parameters_.longest_shoot};
    const Vec3 beside = 6 * parameters_.tip_radius * (i - (count - 1) / 2.0) * normal.cross(up);
    const LineageId lineage =
        child_lineage(plant_lineage(plant.name, random_seed_), LineageKind::Branch, static_cast<uint64_t>(i));
    start_shoot(plant,
                {{ParticleId(), seed_ - beside},
                 BranchId(),
                 lineage,
                 rotation_about(normal, shoot.course) * direction},
                shoot, around, body);
    finish_node(plant, shoots_.size() - 1, around, body);  // full-grown from the start
  }
}

void Shoots::grow(Plant& plant, const Surroundings& around, double dt, Embodiment& body) {
  ++steps_;
  for (size_t i = 0, count = shoots_.size(); i < count; ++i)
    if (shoots_[i].lost_tip) break_bud_below_cut(plant, i, around, body);
  for (size_t i = 0; i < shoots_.size(); ++i) {  // grows while it goes on
    Shoot& shoot = shoots_[i];
    if (!shoot.growing) continue;
    const Draws turns(random_seed_, plant.branches[shoot.branch.index()].lineage, "growth/wander");
    if (grow_tip(plant, shoot, parameters_, around, turns.normal(shoot.steps++), dt))
      finish_node(plant, i, around, body);
  }
  leaves_.grow(plant, around, dt, law_);
  hold_on_again(plant, around);
}

// Towards the end of the particles the leaders have precedence, so that a small plant climbs high rather than
// wide.
bool Shoots::may_grow(const Plant& plant, int level) const {
  return plant.particles.size() < parameters_.max_particles * (1 - 0.15 * std::min(level, 3));
}

bool Shoots::full_grown(const Particle& stem) const {
  return 2 * stem.half_length >= parameters_.segment_length * (1 - 1e-9);
}

void Shoots::start_shoot(Plant& plant, const Start& start, Shoot shoot, const Surroundings& around,
                         Embodiment& body) {
  Branch branch;
  branch.lineage = start.lineage;
  branch.parent = start.parent;
  branch.level = start.parent.valid() ? plant.branches[start.parent.index()].level + 1 : 0;
  branch.group = "level" + std::to_string(branch.level);
  branch.strength = parameters_.strength;
  shoot.branch = BranchId(plant.branches.size());
  plant.branches.push_back(branch);
  append_stem(plant, shoot, start.at, Quat::FromTwoVectors(Vec3::UnitY(), start.direction), around, body);
  shoots_.push_back(shoot);
}

void Shoots::append_stem(Plant& plant, const Shoot& shoot, const Attachment& at, Quat orientation,
                         const Surroundings& around, Embodiment& body) {
  // The first particle of a stem from the seed is full-grown: it is what the seed was.
  const double length = parameters_.segment_length * (at.parent.valid() ? kGrowth.youngest_segment : 1);
  const SegmentShape shape{length / 2, shoot.tip_radius, shoot.tip_radius};
  if (at.parent.valid()) {
    const Vec3 forward = orientation * Vec3::UnitY();
    if (const auto wall = in_the_way(around, head_of(plant, at.parent), forward, shoot.tip_radius, length))
      orientation = Quat::FromTwoVectors(forward, along(*wall, forward, around.to_sun)) * orientation;
  }
  const ParticleId id = append_segment(plant, shoot.branch, at, shape, orientation);
  Branch& branch = plant.branches[shoot.branch.index()];
  branch.length += length;
  if (branch.particles.size() == 1) branch.material = evaluate(law_.group(branch.group), branch.length);
  body.bear_stem(plant, id, shoot.tip_radius);
}

// A particle is full-grown: it holds on, bears a leaf and perhaps lateral shoots, and the tip goes on from
// its head.
void Shoots::finish_node(Plant& plant, size_t index, const Surroundings& around, Embodiment& body) {
  Shoot shoot = shoots_[index];
  const BranchId branch = shoot.branch;
  const ParticleId node = plant.branches[branch.index()].particles.back();
  const Vec3 head = head_of(plant, node), forward = forward_of(plant, node);
  const auto support = closest_support(around.obstacles, head, parameters_.tropisms.search_radius);
  const Vec3 outward = outward_of(support, forward, around.to_sun);
  const Attachment here{node, Vec3(0, plant.particles[node.index()].half_length, 0)};

  shoot.free_length =
      anchors_.attach(plant, node, around) ? 0 : shoot.free_length + parameters_.segment_length;
  shoot.light += (1 - occlusion(around.obstacles, head + 1e-3 * outward, around.to_sun) - shoot.light) / 3;
  crowding_.add(head, branch, node);

  if ((shoot.since_leaf += parameters_.segment_length) >= parameters_.leaves.step &&
      plant.particles.size() < parameters_.max_particles) {
    const BranchId leaf =
        leaves_.sprout(plant, shoot, node, support ? support->normal : outward, around, law_, random_seed_);
    plant.branches[leaf.index()].strength = parameters_.leaf_strength;
    shoot.since_leaf = 0;
    body.bear_leaf(plant);
  }
  const int level = plant.branches[branch.index()].level;
  const LineageId name = plant.lineage_of(node);
  for (const Bud& bud : breaking_buds(shoot, level, head, forward, outward, parameters_.branching, crowding_,
                                      {random_seed_, name, "growth/buds"}))
    if (may_grow(plant, level + 2) && head.y() > around.ground_height + parameters_.segment_length)
      start_shoot(plant, {here, branch, child_lineage(name, LineageKind::Branch, bud.ordinal), bud.direction},
                  {BranchId(), bud.tip_radius, bud.course, shoot.longest / 2, shoot.light}, around, body);

  shoot.growing = plant.branches[branch.index()].length < shoot.longest &&
                  shoot.free_length < parameters_.longest_free && may_grow(plant, level);
  if (shoot.growing) append_stem(plant, shoot, here, plant.motion[node.index()].orientation, around, body);
  shoots_[index] = shoot;
}

void Shoots::follow(const Remap& remap) {
  std::erase_if(shoots_, [&](Shoot& shoot) {
    shoot.branch = remap(shoot.branch);
    if (!shoot.branch.valid()) return true;
    if (remap.was_shortened(shoot.branch)) {
      shoot.growing = false;
      shoot.lost_tip = true;
    }
    return false;
  });
  leaves_.follow(remap);
  anchors_.follow(remap);
  crowding_.follow(remap);
}

// The tip held the buds below it back; without it the last node's breaks.
void Shoots::break_bud_below_cut(Plant& plant, size_t index, const Surroundings& around, Embodiment& body) {
  Shoot& shoot = shoots_[index];
  shoot.lost_tip = false;
  const Branch& branch = plant.branches[shoot.branch.index()];
  const ParticleId node = branch.particles.back();
  const Vec3 head = head_of(plant, node), forward = forward_of(plant, node);
  if (!full_grown(plant.particles[node.index()]) ||
      head.y() <= around.ground_height + parameters_.segment_length)
    return;
  const auto support = closest_support(around.obstacles, head, parameters_.tropisms.search_radius);
  BranchingParameters sure = parameters_.branching;
  sure.probability = 1;
  sure.max_laterals = 1;
  const Shoot parent = shoot;  // start_shoot() moves the shoots
  const int level = branch.level;
  const LineageId name = plant.lineage_of(node);
  for (const Bud& bud :
       breaking_buds(parent, level, head, forward, outward_of(support, forward, around.to_sun), sure,
                     crowding_, {random_seed_, name, "growth/bud below a cut"}))
    if (may_grow(plant, level + 2))
      start_shoot(plant,
                  {{node, Vec3(0, plant.particles[node.index()].half_length, 0)},
                   parent.branch,
                   child_lineage(name, LineageKind::Branch, parameters_.branching.max_laterals),
                   bud.direction},
                  {BranchId(), bud.tip_radius, bud.course, parent.longest / 2, parent.light}, around, body);
}

// A few particles a step are looked at again: a stem that was blown against the wall takes root there. Whose
// turn it is depends on the particle's lineage and on the step, not on what else grows.
void Shoots::hold_on_again(Plant& plant, const Surroundings& around) {
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const ParticleId id(i);
    if ((plant.lineage[i].value + steps_) % kGrowth.hold_turns != 0) continue;
    const Particle& particle = plant.particles[i];
    const bool stem = plant.branches[particle.branch.index()].kind == DomainKind::Branch;
    if (stem && full_grown(particle) && particle.parent.valid()) anchors_.attach(plant, id, around);
  }
}

void Shoots::mark_growing(const Plant& plant, std::vector<uint8_t>& growing) const {
  for (const Shoot& shoot : shoots_)
    if (shoot.growing) growing[plant.branches[shoot.branch.index()].particles.back().index()] = 1;
  leaves_.mark_growing(plant, growing);
}

std::vector<BranchId> Shoots::growing() const {
  std::vector<BranchId> branches;
  for (const Shoot& shoot : shoots_)
    if (shoot.growing) branches.push_back(shoot.branch);
  return branches;
}

}  // namespace liana
