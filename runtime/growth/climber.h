// A climbing plant that grows from a seed: [Haedrich17] §4.2-4.3 on oriented particles that swing as their
// law says.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "materials/law/species_law.h"
#include "runtime/growth/anchors.h"
#include "runtime/growth/crowding.h"
#include "runtime/growth/grown_weight.h"
#include "runtime/growth/leaves.h"
#include "runtime/growth/segments.h"
#include "runtime/growth/shoot_growth.h"
#include "runtime/sim/calibrate/calibration.h"
#include "runtime/sim/model/topology.h"

namespace liana {

struct GrowthReport {
  size_t tips = 0;  ///< shoots that still grow
  size_t leaves = 0;
  size_t anchors = 0;
  size_t released = 0;      ///< anchors torn off so far
  size_t recalibrated = 0;  ///< branches calibrated in this call
  size_t out_of_range = 0;  ///< of these, how many the time step cannot swing as fast as their law says
};

/// Owns what growth needs to know besides the plant. One climber grows one plant, from empty, and is the only
/// one that adds particles, branches or anchors to it; it must hear of what others take away. Deterministic:
/// the same seed and calls grow the same plant.
class Climber {
 public:
  /// seed_position (m) is on the ground, which is taken to be level there. Throws Error{Input} for parameters
  /// out of range or a law without the groups "level0" and "leaf".
  Climber(const ClimberParameters& parameters, const SpeciesLaw& law, const Vec3& seed_position,
          uint64_t random_seed);

  /// Lets the plant grow by dt_growth (growth s, >= 0) from its present, moving state: call it between
  /// time steps with a multiple of their dt. to_sun need not be unit. The plant's time scheme must be set
  /// before.
  GrowthReport grow(Plant& plant, std::span<const SdfObstacle* const> obstacles, const Vec3& to_sun,
                    double dt_growth);

  /// Between steps, after remove_subtree() or detach_subtree(): shoots and leaves that are gone are
  /// forgotten, a shoot that lost its tip stops, and a lateral bud below the cut breaks, where there is room,
  /// as if it had waited for that.
  void follow(const TopologyChange& change);

  /// One flag per particle of the plant: 1 for tips and leaves that are not full-grown.
  void mark_growing(const Plant& plant, std::vector<uint8_t>& growing) const;

  const ClimberParameters& parameters() const { return parameters_; }

  template <class Archive>
  void persist(Archive& a) {
    a(wander_, branching_, leafing_, shoots_, leaves_, anchors_, crowding_, young_radius_, joint_length_,
      calibrated_, stiffness_, kept_, germinated_, next_hold_, next_settled_);
    // not state: parameters_, law_, seed_: set once
    // not state: found_, uncarried_, uncarried_now_, chain_, rest_: working memory of one call
  }

 private:
  /// What a branch was like when it was last calibrated.
  struct Calibrated {
    double length = 0;        // m
    double mass = 0;          // kg, with what it carries
    double base = 0;          // N·m/rad, physical stiffness of its first joint
    bool on_its_way = false;  // to what it should be: it was changed by no more than what is not seen
    double seen_length = 0, seen_base = 0;  // in the last call

    template <class Archive>
    void persist(Archive& a) {
      a(length, mass, base, on_its_way, seen_length, seen_base);
    }
    bool differs(const Calibrated& now, double by) const {
      return on_its_way || std::abs(now.length - length) > by * length ||
             std::abs(now.mass - mass) > by * mass || std::abs(now.base - base) > by * base;
    }
  };
  void grow_once(Plant& plant, const Surroundings& around, double dt);
  void germinate(Plant& plant, const Surroundings& around);
  bool may_grow(const Plant& plant, int level) const;
  void start_shoot(Plant& plant, const Attachment& at, BranchId parent, const Vec3& direction, Shoot shoot,
                   const Surroundings& around);
  ParticleId append_stem(Plant& plant, const Shoot& shoot, const Attachment& at, Quat orientation,
                         const Surroundings& around);
  void set_tip_mass(Plant& plant, ParticleId id) const;
  void finish_node(Plant& plant, size_t shoot, const Surroundings& around);
  void break_bud_below_cut(Plant& plant, size_t shoot, const Surroundings& around);
  void hold_on_again(Plant& plant, const Surroundings& around);
  void note_stiffness(const Plant& plant);
  void keep_loads(Plant& plant, double dt);
  void recalibrate_changed(Plant& plant, double dt, GrowthReport& report);

  ClimberParameters parameters_;
  SpeciesLaw law_;
  Vec3 seed_;
  Random wander_, branching_, leafing_;
  std::vector<Shoot> shoots_;
  Leaves leaves_;
  Anchors anchors_;
  Crowding crowding_;
  std::vector<double> young_radius_, joint_length_;  // m, per particle
  std::vector<Calibrated> calibrated_;               // per branch
  struct Found {
    double mass, base;  // kg, with what it carries; N·m/rad of its first joint
  };
  std::vector<Found> found_;  // per branch, now
  struct ByJoint {
    Vec3 shear, bend;

    template <class Archive>
    void persist(Archive& a) {
      a(shear, bend);
    }
  };
  std::vector<ByJoint> stiffness_;                    // N/m, N·m/rad, per particle, as the last call left it
  std::vector<ByJoint> kept_;                         // N, N·m, per particle
  std::vector<JointLoad> uncarried_, uncarried_now_;  // per particle, before the present call and in it
  HeldChain chain_;
  std::vector<RestPose> rest_;
  bool germinated_ = false;
  size_t next_hold_ = 0;     // particle looked at next for a new anchor
  size_t next_settled_ = 0;  // branch whose turn to be calibrated finely comes next
};

}  // namespace liana
