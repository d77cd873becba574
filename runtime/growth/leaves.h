// Leaves: one particle each, on a petiole, put along a shoot by phyllotaxis; they grow and turn to the light.
#pragma once

#include <vector>

#include "runtime/growth/shoot_growth.h"
#include "runtime/sim/model/topology.h"

namespace liana {

class Leaves {
 public:
  explicit Leaves(const LeafParameters& parameters) : parameters_(parameters) {}

  /// A young leaf at the head of a shoot's full-grown particle. `outward` (unit) points away from the
  /// support.
  BranchId sprout(Plant& plant, Shoot& shoot, ParticleId node, const Vec3& outward,
                  const Surroundings& around, const SpeciesLaw& law, Random& random);

  /// Enlarges and turns the leaves that are not full-grown.
  void grow(Plant& plant, const Surroundings& around, double dt, const SpeciesLaw& law);

  /// Sets the flags of the particles whose leaves are not full-grown.
  void mark_growing(const Plant& plant, std::vector<uint8_t>& growing) const;

  /// The plant lost particles, and leaves with them.
  void follow(const TopologyChange& change);

  size_t count() const { return leaves_.size(); }

  template <class Archive>
  void persist(Archive& a) {
    a(leaves_, first_growing_);
    // not state: parameters_: set once
  }

 private:
  struct Leaf {
    BranchId branch;
    double full_length, full_width;  // m
    Vec3 outward;                    // unit
    double age = 0;                  // growth s

    template <class Archive>
    void persist(Archive& a) {
      a(branch, full_length, full_width, outward, age);
    }
  };
  void resize(Plant& plant, const Leaf& leaf, double size, const SpeciesLaw& law) const;

  LeafParameters parameters_;
  std::vector<Leaf> leaves_;
  size_t first_growing_ = 0;  // leaves of one age sprout in order, so the grown ones come first
};

}  // namespace liana
