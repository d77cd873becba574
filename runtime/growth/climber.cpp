#include "runtime/growth/climber.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"
#include "mesher/base/random.h"
#include "runtime/growth/branching.h"
#include "runtime/growth/light.h"
#include "runtime/growth/thickening.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/model/rotation.h"
#include "runtime/sim/step/joints.h"

namespace liana {
namespace {

constexpr double kYoungestSegment = 0.25;  // length of a new particle, of a full-grown one's
constexpr double kNewbornMass = 0.02;      // of a full-grown one's: what it weighs at first nobody sees
constexpr double kLongestStep = 0.05;      // growth s; longer ones are cut
constexpr double kUnseenJump = 0.01;       // of a tip's speed, that a step's calibration may change it by
constexpr double kMostAtOnce = 0.01;      // of a stiffness, beyond what its growth changes it by in that step
constexpr double kStiffnessByLength = 3;  // exponent, about: of a branch that keeps to its law while it grows
constexpr double kForget = 1;             // growth s, in which a bent joint gets used to its new stiffness
constexpr uint64_t kTurnsToHold = 64;     // steps of growth in which every stem is tried for a hold once
constexpr uint64_t kTurnsToSettle = 100;  // calls in which every branch is calibrated finely once
constexpr double kLeafStrand = 0.35;      // of the petiole's radius: what a leaf adds to the stems below

/// Away from the support; away from the stem's underside where there is none.
Vec3 outward_of(const std::optional<Support>& support, const Vec3& forward, const Vec3& to_sun) {
  const Vec3 away = support ? support->normal : to_sun;
  const Vec3 across = away - away.dot(forward) * forward;
  return across.norm() > 1e-3 ? across.normalized() : forward.unitOrthogonal();
}

void check(bool sound, const char* what) {
  if (!sound) throw Error(Error::Kind::Input, what, "the defaults of ClimberParameters grow an ivy");
}

}  // namespace

Climber::Climber(const ClimberParameters& parameters, const SpeciesLaw& law, const Vec3& seed_position,
                 uint64_t random_seed)
    : parameters_(parameters),
      law_(law),
      seed_(seed_position),
      random_seed_(random_seed),
      leaves_(parameters.leaves),
      anchors_(parameters.anchors, parameters.tip_radius),
      crowding_(std::max(parameters.branching.room, 0.02)) {
  const ClimberParameters& p = parameters_;
  check(seed_position.allFinite(), "a climber's seed is not at a finite place");
  check(p.elongation > 0 && p.elongation < 1, "a climber's elongation is not between 0 and 1 m/s");
  check(p.segment_length >= 5e-3 && p.segment_length <= 1, "a climber's segments are not 5 mm to 1 m long");
  check(p.tip_radius > 1e-5 && p.tip_radius < p.segment_length / 2,
        "a climber's tip is too thin or too thick");
  check(p.first_shoots >= 1 && p.first_shoots <= 64, "a climber needs 1 to 64 first shoots");
  check(p.pipe_exponent >= 1 && p.pipe_exponent <= 4, "a climber's pipe exponent is not between 1 and 4");
  check(p.leaves.step > 0 && p.leaves.length > 0 && p.leaves.width > 0 && p.leaves.thickness > 0 &&
            p.leaves.petiole > 0 && p.leaves.petiole_radius > 0 && p.leaves.seconds_to_full > 0 &&
            p.leaves.variation >= 0 && p.leaves.variation < 1,
        "a climber's leaves have no size");
  check(p.branching.variance >= 0 && p.branching.variance <= 1 && p.branching.falloff > 0 &&
            p.branching.falloff <= 1,
        "a climber's branching variance or falloff is not between 0 and 1");
  check(p.max_particles >= 1 && p.max_particles <= 1'000'000, "a climber may have 1 to 1,000,000 particles");
  law_.group("level0"), law_.group("leaf");
}

GrowthReport Climber::grow(Plant& plant, std::span<const SdfObstacle* const> obstacles, const Vec3& to_sun,
                           double dt) {
  const Surroundings around{obstacles, to_sun.normalized(), seed_.y()};
  if (!germinated_) germinate(plant, around);
  if (plant.particles.empty()) return {.released = anchors_.released()};  // all of it was cut
  // What weight the joints feel before this growth; keep_loads() bears what comes to that.
  const Vec3 shaped_by = parameters_.weight_grown_in * parameters_.gravity;
  carry_grown_weight(plant, shaped_by, rest_);
  uncarried_weight(plant, parameters_.gravity, uncarried_);
  note_stiffness(plant);
  const int parts = std::max(1, static_cast<int>(std::ceil(dt / kLongestStep - 1e-9)));
  for (int i = 0; i < parts; ++i) grow_once(plant, around, dt / parts);
  anchors_.update(plant, dt);

  GrowthReport report;
  recalibrate_changed(plant, dt, report);
  carry_grown_weight(plant, shaped_by, rest_);
  keep_loads(plant, dt);
  report.tips = std::count_if(shoots_.begin(), shoots_.end(), [](const Shoot& s) { return s.growing; });
  report.leaves = leaves_.count();
  report.anchors = anchors_.count();
  report.released = anchors_.released();
  return report;
}

void Climber::grow_once(Plant& plant, const Surroundings& around, double dt) {
  ++steps_;
  for (size_t i = 0, count = shoots_.size(); i < count; ++i)
    if (shoots_[i].lost_tip) break_bud_below_cut(plant, i, around);
  for (size_t i = 0; i < shoots_.size(); ++i) {  // grows while it goes on
    Shoot& shoot = shoots_[i];
    if (!shoot.growing) continue;
    const Draws turns(random_seed_, plant.branches[shoot.branch.index()].lineage, "growth/wander");
    if (grow_tip(plant, shoot, parameters_, around, turns.normal(shoot.steps++), dt))
      finish_node(plant, i, around);
  }
  leaves_.grow(plant, around, dt, law_);
  hold_on_again(plant, around);
  thicken(
      plant, young_radius_, joint_length_,
      {parameters_.pipe_exponent, kLeafStrand * parameters_.leaves.petiole_radius, parameters_.thickening},
      law_.default_material, dt);
}

// Every first shoot stands in the ground by itself, beside the others, and leans towards the support in a
// fan.
void Climber::germinate(Plant& plant, const Surroundings& around) {
  germinated_ = true;
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
    start_shoot(plant, {ParticleId(), seed_ - beside}, BranchId(), lineage,
                rotation_about(normal, shoot.course) * direction, shoot, around);
    finish_node(plant, shoots_.size() - 1, around);  // full-grown from the start
  }
}

// Towards the end of the particles the leaders have precedence, so that a small plant climbs high rather than
// wide.
bool Climber::may_grow(const Plant& plant, int level) const {
  return plant.particles.size() < parameters_.max_particles * (1 - 0.15 * std::min(level, 3));
}

void Climber::start_shoot(Plant& plant, const Attachment& at, BranchId parent, LineageId lineage,
                          const Vec3& direction, Shoot shoot, const Surroundings& around) {
  Branch branch;
  branch.lineage = lineage;
  branch.parent = parent;
  branch.level = parent.valid() ? plant.branches[parent.index()].level + 1 : 0;
  branch.group = "level" + std::to_string(branch.level);
  branch.strength = parameters_.strength;
  shoot.branch = BranchId(plant.branches.size());
  plant.branches.push_back(branch);
  append_stem(plant, shoot, at, Quat::FromTwoVectors(Vec3::UnitY(), direction), around);
  shoots_.push_back(shoot);
}

ParticleId Climber::append_stem(Plant& plant, const Shoot& shoot, const Attachment& at, Quat orientation,
                                const Surroundings& around) {
  // The first particle of a stem from the seed is full-grown: it is what the seed was.
  const double length = parameters_.segment_length * (at.parent.valid() ? kYoungestSegment : 1);
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

  young_radius_.resize(plant.particles.size(), 0);
  joint_length_.resize(plant.particles.size(), 0);
  young_radius_[id.index()] = shoot.tip_radius;
  joint_length_[id.index()] = parameters_.segment_length;
  Particle& particle = plant.particles[id.index()];
  set_tip_mass(plant, id);
  // For its full length, so that lengthening does not change it.
  const ElasticMaterial& material = law_.default_material;
  set_section(
      particle.joint,
      rod_section(material.youngs_modulus, material.poisson_ratio, shoot.tip_radius, shoot.tip_radius, 1),
      parameters_.segment_length, branch.stiffness_scale);
  if (branch.particles.size() > 1) {
    const Particle& before = plant.particles[at.parent.index()];
    particle.mass_damping = before.mass_damping;
    particle.stiffness_damping = before.stiffness_damping;
  }
  return id;
}

// A segment is born with a length, but grows from hardly any mass to its own while it lengthens.
void Climber::set_tip_mass(Plant& plant, ParticleId id) const {
  Particle& tip = plant.particles[id.index()];
  const double share = 2 * tip.half_length / parameters_.segment_length;
  const double grown = std::max(kNewbornMass, (share - kYoungestSegment) / (1 - kYoungestSegment));
  const double scaling = plant.branches[tip.branch.index()].material.mass_scaling;
  set_mass(tip, DomainKind::Branch, law_.default_material.density * scaling * grown / share);
}

// A particle is full-grown: it holds on, bears a leaf and perhaps lateral shoots, and the tip goes on from
// its head.
void Climber::finish_node(Plant& plant, size_t index, const Surroundings& around) {
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
    young_radius_.push_back(0);
    joint_length_.push_back(0);
  }
  const int level = plant.branches[branch.index()].level;
  const LineageId name = plant.lineage_of(node);
  for (const Bud& bud : breaking_buds(shoot, level, head, forward, outward, parameters_.branching, crowding_,
                                      {random_seed_, name, "growth/buds"}))
    if (may_grow(plant, level + 2) && head.y() > around.ground_height + parameters_.segment_length)
      start_shoot(plant, here, branch, child_lineage(name, LineageKind::Branch, bud.ordinal), bud.direction,
                  {BranchId(), bud.tip_radius, bud.course, shoot.longest / 2, shoot.light}, around);

  shoot.growing = plant.branches[branch.index()].length < shoot.longest &&
                  shoot.free_length < parameters_.longest_free && may_grow(plant, level);
  if (shoot.growing) append_stem(plant, shoot, here, plant.motion[node.index()].orientation, around);
  shoots_[index] = shoot;
}

void Climber::follow(const TopologyChange& change) {
  std::erase_if(shoots_, [&](Shoot& shoot) {
    shoot.branch = change.branches[shoot.branch.index()];
    if (!shoot.branch.valid()) return true;
    if (shoot.branch == change.shortened) {
      shoot.growing = false;
      shoot.lost_tip = true;
    }
    return false;
  });
  leaves_.follow(change);
  anchors_.follow(change);
  crowding_.follow(change);
  const auto keep = [](auto& numbers, const auto& now) {
    size_t kept = 0;
    for (size_t i = 0; i < numbers.size(); ++i)
      if (now[i].valid()) numbers[kept++] = numbers[i];
    numbers.resize(kept);
  };
  keep(young_radius_, change.particles);
  keep(joint_length_, change.particles);
  keep(stiffness_, change.particles);
  keep(kept_, change.particles);
  keep(calibrated_, change.branches);
}

// The tip held the buds below it back; without it the last node's breaks.
void Climber::break_bud_below_cut(Plant& plant, size_t index, const Surroundings& around) {
  Shoot& shoot = shoots_[index];
  shoot.lost_tip = false;
  const Branch& branch = plant.branches[shoot.branch.index()];
  const ParticleId node = branch.particles.back();
  const Vec3 head = head_of(plant, node), forward = forward_of(plant, node);
  const bool grown = 2 * plant.particles[node.index()].half_length >= parameters_.segment_length * (1 - 1e-9);
  if (!grown || head.y() <= around.ground_height + parameters_.segment_length) return;
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
      start_shoot(plant, {node, Vec3(0, plant.particles[node.index()].half_length, 0)}, parent.branch,
                  child_lineage(name, LineageKind::Branch, parameters_.branching.max_laterals), bud.direction,
                  {BranchId(), bud.tip_radius, bud.course, parent.longest / 2, parent.light}, around);
}

// A few particles a step are looked at again: a stem that was blown against the wall takes root there. Whose
// turn it is depends on the particle's lineage and on the step, not on what else grows.
void Climber::hold_on_again(Plant& plant, const Surroundings& around) {
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const ParticleId id(i);
    if ((plant.lineage[i].value + steps_) % kTurnsToHold != 0) continue;
    const Particle& particle = plant.particles[i];
    const bool stem = plant.branches[particle.branch.index()].kind == DomainKind::Branch;
    const bool grown = 2 * particle.half_length >= parameters_.segment_length * (1 - 1e-9);
    if (stem && grown && particle.parent.valid()) anchors_.attach(plant, id, around);
  }
}

void Climber::mark_growing(const Plant& plant, std::vector<uint8_t>& growing) const {
  growing.assign(plant.particles.size(), 0);
  for (const Shoot& shoot : shoots_)
    if (shoot.growing) growing[plant.branches[shoot.branch.index()].particles.back().index()] = 1;
  leaves_.mark_growing(plant, growing);
}

void Climber::note_stiffness(const Plant& plant) {
  for (size_t i = stiffness_.size(); i < plant.particles.size(); ++i) {
    const Joint& joint = plant.particles[i].joint;
    stiffness_.push_back({joint.shear_stiffness, joint.bend_stiffness});
  }
}

// A joint whose stiffness changed while it is bent exerts what it did, and bears what grew beyond it where
// that is now, not where it would be at rest; it forgets both slowly.
void Climber::keep_loads(Plant& plant, double dt) {
  const auto pose = [&](ParticleId p) {
    const Motion& m = plant.motion[p.index()];
    return BodyPose{.position = m.position, .orientation = m.orientation};
  };
  kept_.resize(plant.particles.size(), {Vec3::Zero(), Vec3::Zero()});
  const double left = fixed::exp(-dt / kForget);
  uncarried_weight(plant, parameters_.gravity, uncarried_now_);
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    Particle& particle = plant.particles[i];
    Joint& joint = particle.joint;
    ByJoint& kept = kept_[i];
    kept.shear *= left, kept.bend *= left;
    kept.shear += uncarried_now_[i].force;
    kept.bend += uncarried_now_[i].moment;
    if (i >= stiffness_.size()) {  // newborn
      joint.rest_force += kept.shear;
      joint.rest_moment += kept.bend;
      continue;
    }
    kept.shear -= uncarried_[i].force;
    kept.bend -= uncarried_[i].moment;
    const Vec3 shear = joint.shear_stiffness - stiffness_[i].shear,
               bend = joint.bend_stiffness - stiffness_[i].bend;
    if (!shear.isZero(0) || !bend.isZero(0)) {
      const JointStrain e = joint_strain(joint, particle.parent.valid() ? pose(particle.parent) : BodyPose(),
                                         pose(ParticleId(i)));
      stiffness_[i] = {joint.shear_stiffness, joint.bend_stiffness};
      kept.shear += shear.cwiseProduct(e.shear);
      kept.bend += bend.cwiseProduct(e.bend.vector);
    }
    joint.rest_force += kept.shear;
    joint.rest_moment += kept.bend;
  }
  note_stiffness(plant);
}

void Climber::recalibrate_changed(Plant& plant, double dt, GrowthReport& report) {
  for (const Shoot& shoot : shoots_) {
    if (!shoot.growing) continue;
    set_tip_mass(plant, plant.branches[shoot.branch.index()].particles.back());
  }
  const std::vector<double> carried = carried_masses(plant);
  calibrated_.resize(plant.branches.size());
  ++calls_;
  found_.assign(plant.branches.size(), {-1, 0});
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& particle = plant.particles[i];
    Found& found = found_[particle.branch.index()];
    if (found.mass < 0) found = {0, particle.joint.bend_stiffness.x()};  // its first
    found.mass += particle.mass + carried[i];
  }
  for (size_t i = 0; i < plant.branches.size(); ++i) {
    Branch& branch = plant.branches[i];
    Calibrated& last = calibrated_[i];
    Calibrated now{
        .length = branch.length, .mass = found_[i].mass, .base = found_[i].base / branch.stiffness_scale};
    now.seen_length = now.length, now.seen_base = now.base;
    // A new node lengthens a shoot at once: that, too, is made good in steps.
    double longer =
        now.length == last.seen_length ? 0 : std::max(0.0, fixed::log(now.length / last.seen_length));
    if (branch.kind != DomainKind::Leaf) longer = std::min(longer, parameters_.elongation * dt / now.length);
    const double stiffer = now.base == last.seen_base ? 0 : std::abs(fixed::log(now.base / last.seen_base));
    const double grown = kStiffnessByLength * longer + stiffer;
    last.seen_length = now.length, last.seen_base = now.base;
    const bool its_turn = (branch.lineage.value + calls_) % kTurnsToSettle == 0;
    const double by = its_turn ? parameters_.settled : parameters_.recalibration;
    if (!last.differs(now, by)) continue;
    // A relative change of a swinging branch's stiffness, times (ωΔt)², is what its tip's velocity jumps by;
    // leaves that it carries low down move less and jump by more of that.
    const double phase = 2 * kPi * branch.material.frequency * plant.scheme.dt,
                 unseen = kUnseenJump / (phase * phase);
    const double scaling = branch.material.mass_scaling;
    branch.material = evaluate(law_.group(branch.group), branch.length);
    const double heavier = branch.material.mass_scaling / scaling;
    for (const ParticleId p : branch.particles) {
      plant.particles[p.index()].mass *= heavier;
      plant.particles[p.index()].inertia *= heavier;
    }
    const double most = last.length == 0 ? HUGE_VAL : std::min(unseen, kMostAtOnce) + grown;
    const double before = branch.stiffness_scale;
    if (!recalibrate(plant, BranchId(i), carried, chain_, most)) ++report.out_of_range;
    now.on_its_way = std::abs(fixed::log(branch.stiffness_scale / before)) > 0.999 * most;
    last = now;
    ++report.recalibrated;
  }
}

}  // namespace liana
