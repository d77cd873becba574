// What growth does to the particles that carry a plant: their mass and stiffness, what their joints bear, and
// how their branches are calibrated while they grow. Nothing here decides what grows where.
#pragma once

#include <cmath>
#include <vector>

#include "materials/law/species_law.h"
#include "runtime/growth/climber_parameters.h"
#include "runtime/growth/embodiment/grown_weight.h"
#include "runtime/sim/calibrate/calibration.h"
#include "runtime/sim/model/remap.h"

namespace liana {

/// Of one call of recalibrate().
struct Recalibration {
  size_t branches = 0;      ///< calibrated
  size_t out_of_range = 0;  ///< of these, how many the time step cannot swing as fast as their law says
};

/// One per plant that grows. A step of growth is begin(), births and lengthening, recalibrate(), end().
class Embodiment {
 public:
  Embodiment(const ClimberParameters& parameters, const SpeciesLaw& law)
      : parameters_(parameters), law_(law) {}

  /// Gives a new stem particle of this young radius (m) its mass, its joint's stiffness and its damping.
  void bear_stem(Plant& plant, ParticleId stem, double tip_radius);
  /// A leaf has been born as the last particle.
  void bear_leaf(const Plant& plant);

  /// Notes what the joints feel before this step.
  void begin(Plant& plant);
  /// Stems thicken with what they carry, for dt growth seconds.
  void thicken_stems(Plant& plant, double dt);
  /// Branches whose length, mass or stiffness changed are brought nearer to what their law says, by no more
  /// than what is not seen. growing: the branches whose last particle still grows.
  Recalibration recalibrate_changed(Plant& plant, const std::vector<BranchId>& growing, double dt);
  /// Joints bear what grew, and what they bore before, from where they are now.
  void end(Plant& plant, double dt);

  /// The plant lost particles.
  void follow(const Remap& remap);

  template <class Archive>
  void persist(Archive& a) {
    a(young_radius_, joint_length_, calibrated_, stiffness_, kept_, calls_);
    // not state: parameters_, law_: given again; rest_, found_, uncarried_, uncarried_now_, chain_: memory of
    // one step
  }

 private:
  /// What a branch was like when it was last calibrated.
  struct Calibrated {
    double length = 0;        // m
    double mass = 0;          // kg, with what it carries
    double base = 0;          // N·m/rad, physical stiffness of its first joint
    bool on_its_way = false;  // to what it should be: it was changed by no more than what is not seen
    double seen_length = 0, seen_base = 0;  // in the last call
    bool differs(const Calibrated& now, double by) const {
      return on_its_way || std::abs(now.length - length) > by * length ||
             std::abs(now.mass - mass) > by * mass || std::abs(now.base - base) > by * base;
    }
    template <class Archive>
    void persist(Archive& a) {
      a(length, mass, base, on_its_way, seen_length, seen_base);
    }
  };
  struct Found {
    double mass, base;  // kg, with what it carries; N·m/rad of its first joint
  };
  struct ByJoint {
    Vec3 shear, bend;
    template <class Archive>
    void persist(Archive& a) {
      a(shear, bend);
    }
  };
  void set_tip_mass(Plant& plant, ParticleId tip) const;
  void note_stiffness(const Plant& plant);
  void find_branches(const Plant& plant, const std::vector<double>& carried);
  /// Of a branch's stiffness, relative: what its growth since the last call accounts for.
  double grown_by(const Branch& branch, const Calibrated& now, const Calibrated& last, double dt) const;
  bool recalibrate_one(Plant& plant, BranchId branch, const std::vector<double>& carried, Calibrated now,
                       double grown);

  ClimberParameters parameters_;
  SpeciesLaw law_;
  std::vector<double> young_radius_, joint_length_;   // m, per particle
  std::vector<Calibrated> calibrated_;                // per branch
  std::vector<Found> found_;                          // per branch, now
  std::vector<ByJoint> stiffness_;                    // N/m, N·m/rad, per particle, as the last call left it
  std::vector<ByJoint> kept_;                         // N, N·m, per particle
  std::vector<JointLoad> uncarried_, uncarried_now_;  // per particle, before the present call and in it
  HeldChain chain_;
  std::vector<RestPose> rest_;
  uint64_t calls_ = 0;
};

}  // namespace liana
