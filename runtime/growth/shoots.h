// Where shoots go: germination, what a full-grown particle of a stem bears, buds, and where shoots end.
#pragma once

#include <vector>

#include "materials/law/species_law.h"
#include "runtime/growth/anchors.h"
#include "runtime/growth/crowding.h"
#include "runtime/growth/embodiment/embodiment.h"
#include "runtime/growth/leaves.h"
#include "runtime/growth/segments.h"
#include "runtime/growth/shoot_growth.h"

namespace liana {

/// The shoots of one plant, with the leaves, anchors and places that they make. Every random draw is keyed by
/// the lineage of what it is for.
class Shoots {
 public:
  Shoots(const ClimberParameters& parameters, const SpeciesLaw& law, const Vec3& seed, uint64_t random_seed);

  /// The first shoots, in an empty plant.
  void germinate(Plant& plant, const Surroundings& around, Embodiment& body);

  /// One step of at most GrowthWeights::longest_step.
  void grow(Plant& plant, const Surroundings& around, double dt, Embodiment& body);

  /// Sets the flags of tips and of leaves that are not full-grown.
  void mark_growing(const Plant& plant, std::vector<uint8_t>& growing) const;
  std::vector<BranchId> growing() const;  ///< branches with a tip that grows

  /// The plant lost particles: a shoot that lost its tip stops, and a bud below the cut breaks in the next
  /// step.
  void follow(const Remap& remap);

  const Leaves& leaves() const { return leaves_; }
  Anchors& anchors() { return anchors_; }

  template <class Archive>
  void persist(Archive& a) {
    a(shoots_, leaves_, anchors_, crowding_, steps_);
    // not state: parameters_, law_, seed_, random_seed_: given again
  }

 private:
  /// What a shoot starts from.
  struct Start {
    Attachment at;
    BranchId parent;
    LineageId lineage;
    Vec3 direction;  // unit
  };
  bool may_grow(const Plant& plant, int level) const;
  bool full_grown(const Particle& stem) const;
  void start_shoot(Plant& plant, const Start& start, Shoot shoot, const Surroundings& around,
                   Embodiment& body);
  void append_stem(Plant& plant, const Shoot& shoot, const Attachment& at, Quat orientation,
                   const Surroundings& around, Embodiment& body);
  void finish_node(Plant& plant, size_t shoot, const Surroundings& around, Embodiment& body);
  void break_bud_below_cut(Plant& plant, size_t shoot, const Surroundings& around, Embodiment& body);
  void hold_on_again(Plant& plant, const Surroundings& around);

  ClimberParameters parameters_;
  SpeciesLaw law_;
  Vec3 seed_;  // m
  uint64_t random_seed_;
  std::vector<Shoot> shoots_;
  Leaves leaves_;
  Anchors anchors_;
  Crowding crowding_;
  uint64_t steps_ = 0;
};

}  // namespace liana
