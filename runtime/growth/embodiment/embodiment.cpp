#include "runtime/growth/embodiment/embodiment.h"

#include <algorithm>

#include "mesher/base/fixed_math.h"
#include "runtime/growth/embodiment/thickening.h"
#include "runtime/growth/growth_weights.h"
#include "runtime/growth/segments.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/step/joints.h"

namespace liana {

void Embodiment::bear_stem(Plant& plant, ParticleId id, double tip_radius) {
  young_radius_.resize(plant.particles.size(), 0);
  joint_length_.resize(plant.particles.size(), 0);
  young_radius_[id.index()] = tip_radius;
  joint_length_[id.index()] = parameters_.segment_length;
  Particle& particle = plant.particles[id.index()];
  const Branch& branch = plant.branches[particle.branch.index()];
  set_tip_mass(plant, id);
  // For its full length, so that lengthening does not change it.
  const ElasticMaterial& material = law_.default_material;
  set_section(particle.joint,
              rod_section(material.youngs_modulus, material.poisson_ratio, tip_radius, tip_radius, 1),
              parameters_.segment_length, branch.stiffness_scale);
  if (branch.particles.size() < 2) return;
  const Particle& before = plant.particles[particle.parent.index()];
  particle.mass_damping = before.mass_damping;
  particle.stiffness_damping = before.stiffness_damping;
}

void Embodiment::bear_leaf(const Plant& plant) {
  young_radius_.resize(plant.particles.size(), 0);
  joint_length_.resize(plant.particles.size(), 0);
}

// A segment is born with a length, but grows from hardly any mass to its own while it lengthens.
void Embodiment::set_tip_mass(Plant& plant, ParticleId id) const {
  Particle& tip = plant.particles[id.index()];
  const double share = 2 * tip.half_length / parameters_.segment_length, youngest = kGrowth.youngest_segment;
  const double grown = std::max(kGrowth.newborn_mass, (share - youngest) / (1 - youngest));
  const double scaling = plant.branches[tip.branch.index()].material.mass_scaling;
  set_mass(tip, DomainKind::Branch, law_.default_material.density * scaling * grown / share);
}

void Embodiment::thicken_stems(Plant& plant, double dt) {
  thicken(plant, young_radius_, joint_length_,
          {parameters_.pipe_exponent, kGrowth.leaf_strand * parameters_.leaves.petiole_radius,
           parameters_.thickening},
          law_.default_material, dt);
}

// What weight the joints feel before this growth; end() bears what comes to that.
void Embodiment::begin(Plant& plant) {
  carry_grown_weight(plant, parameters_.weight_grown_in * parameters_.gravity, rest_);
  uncarried_weight(plant, parameters_.gravity, uncarried_);
  note_stiffness(plant);
}

void Embodiment::note_stiffness(const Plant& plant) {
  for (size_t i = stiffness_.size(); i < plant.particles.size(); ++i) {
    const Joint& joint = plant.particles[i].joint;
    stiffness_.push_back({joint.shear_stiffness, joint.bend_stiffness});
  }
}

// A joint whose stiffness changed while it is bent exerts what it did, and bears what grew beyond it where
// that is now, not where it would be at rest; it forgets both slowly.
void Embodiment::end(Plant& plant, double dt) {
  carry_grown_weight(plant, parameters_.weight_grown_in * parameters_.gravity, rest_);
  const auto pose = [&](ParticleId p) {
    const Motion& m = plant.motion[p.index()];
    return BodyPose{.position = m.position, .orientation = m.orientation};
  };
  kept_.resize(plant.particles.size(), {Vec3::Zero(), Vec3::Zero()});
  const double left = fixed::exp(-dt / kGrowth.forget);
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

Recalibration Embodiment::recalibrate_changed(Plant& plant, const std::vector<BranchId>& growing, double dt) {
  for (const BranchId branch : growing) set_tip_mass(plant, plant.branches[branch.index()].particles.back());
  const std::vector<double> carried = carried_masses(plant);
  calibrated_.resize(plant.branches.size());
  ++calls_;
  find_branches(plant, carried);
  Recalibration report;
  for (size_t i = 0; i < plant.branches.size(); ++i) {
    const Branch& branch = plant.branches[i];
    Calibrated& last = calibrated_[i];
    Calibrated now{
        .length = branch.length, .mass = found_[i].mass, .base = found_[i].base / branch.stiffness_scale};
    now.seen_length = now.length, now.seen_base = now.base;
    const double grown = grown_by(branch, now, last, dt);
    last.seen_length = now.length, last.seen_base = now.base;
    // Whose turn it is depends on its lineage and on the call, not on what else grows.
    const bool its_turn = (branch.lineage.value + calls_) % kGrowth.settle_turns == 0;
    if (!last.differs(now, its_turn ? parameters_.settled : parameters_.recalibration)) continue;
    report.out_of_range += !recalibrate_one(plant, BranchId(i), carried, now, grown);
    ++report.branches;
  }
  return report;
}

void Embodiment::find_branches(const Plant& plant, const std::vector<double>& carried) {
  found_.assign(plant.branches.size(), {-1, 0});
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& particle = plant.particles[i];
    Found& found = found_[particle.branch.index()];
    if (found.mass < 0) found = {0, particle.joint.bend_stiffness.x()};  // its first
    found.mass += particle.mass + carried[i];
  }
}

double Embodiment::grown_by(const Branch& branch, const Calibrated& now, const Calibrated& last,
                            double dt) const {
  double longer =
      now.length == last.seen_length ? 0 : std::max(0.0, fixed::log(now.length / last.seen_length));
  // A new node lengthens a shoot at once: that, too, is made good in steps.
  if (branch.kind != DomainKind::Leaf) longer = std::min(longer, parameters_.elongation * dt / now.length);
  const double stiffer = now.base == last.seen_base ? 0 : std::abs(fixed::log(now.base / last.seen_base));
  return GrowthWeights::stiffness_by_length(law_.group(branch.group).epsilon1) * longer + stiffer;
}

// A relative change of a swinging branch's stiffness, times (ωΔt)², is what its tip's velocity jumps by;
// leaves that it carries low down move less and jump by more of that.
bool Embodiment::recalibrate_one(Plant& plant, BranchId id, const std::vector<double>& carried,
                                 Calibrated now, double grown) {
  Branch& branch = plant.branches[id.index()];
  Calibrated& last = calibrated_[id.index()];
  const double phase = 2 * kPi * branch.material.frequency * plant.scheme.dt,
               unseen = kGrowth.unseen_jump / (phase * phase);
  const double scaling = branch.material.mass_scaling;
  branch.material = evaluate(law_.group(branch.group), branch.length);
  const double heavier = branch.material.mass_scaling / scaling;
  for (const ParticleId p : branch.particles) {
    plant.particles[p.index()].mass *= heavier;
    plant.particles[p.index()].inertia *= heavier;
  }
  const double most = last.length == 0 ? HUGE_VAL : std::min(unseen, kGrowth.most_at_once) + grown;
  const double before = branch.stiffness_scale;
  const bool in_range = recalibrate(plant, id, carried, chain_, most);
  now.on_its_way = std::abs(fixed::log(branch.stiffness_scale / before)) > 0.999 * most;
  last = now;
  return in_range;
}

void Embodiment::follow(const Remap& remap) {
  remap.keep_particles(young_radius_);
  remap.keep_particles(joint_length_);
  remap.keep_particles(stiffness_);
  remap.keep_particles(kept_);
  remap.keep_branches(calibrated_);
}

}  // namespace liana
