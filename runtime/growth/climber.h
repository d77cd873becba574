// A climbing plant that grows from a seed: [Haedrich17] §4.2-4.3 on oriented particles that swing as their
// law says.
#pragma once

#include <span>
#include <vector>

#include "materials/law/species_law.h"
#include "runtime/growth/embodiment/embodiment.h"
#include "runtime/growth/shoots.h"

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
/// one that adds particles, branches or anchors to it. Deterministic: the same seed and calls grow the same
/// plant. First shoots stand in the ground each by itself: what happens to one changes no bit of those that
/// never met it (but see ClimberParameters::max_particles).
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

  /// Takes what was removed from the plant: shoots and leaves that are gone are forgotten, a shoot that lost
  /// its tip stops, and a lateral bud below the cut breaks, where there is room, as if it had waited for
  /// that. grow() does it first; call it where the plant's removals are cleared.
  void take(const Plant& plant);

  /// One flag per particle of the plant: 1 for tips and leaves that are not full-grown.
  void mark_growing(const Plant& plant, std::vector<uint8_t>& growing) const;

  const ClimberParameters& parameters() const { return parameters_; }

  template <class Archive>
  void persist(Archive& a) {
    a(shoots_, body_, slots_, germinated_);
    // not state: parameters_, ground_: given again
  }

 private:
  ClimberParameters parameters_;
  double ground_;  // m, height
  Shoots shoots_;
  Embodiment body_;
  SlotCache slots_;
  bool germinated_ = false;
};

}  // namespace liana
