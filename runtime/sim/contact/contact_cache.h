// What pairs of particles that touch remember from step to step.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

#include "runtime/sim/contact/contact_response.h"
#include "runtime/sim/model/remap.h"

namespace liana {

/// A particle among all plants.
struct ParticleName {
  uint32_t plant, particle;
  auto operator<=>(const ParticleName&) const = default;

  template <class Archive>
  void persist(Archive& a) {
    a(plant, particle);
  }
};

struct PairName {
  ParticleName a, b;
  auto operator<=>(const PairName&) const = default;

  template <class Archive>
  void persist(Archive& archive) {
    archive(a, b);
  }
};

struct CachedContact {
  PairName pair;
  Vec3 normal = Vec3::Zero();  ///< from b to a
  bool exempt = false;         ///< overlapped when first seen, and has not come apart since
  StickAnchor anchor = {};

  template <class Archive>
  void persist(Archive& a) {
    a(pair, normal, exempt, anchor);
  }
};

/// plants[plant] lost particles: what is known of the others goes with them.
inline void follow(std::vector<CachedContact>& cache, uint32_t plant, const Remap& remap) {
  std::erase_if(cache, [&](CachedContact& contact) {
    for (ParticleName* name : {&contact.pair.a, &contact.pair.b}) {
      if (name->plant != plant) continue;
      const ParticleId now = remap.particles[name->particle];
      if (!now.valid()) return true;
      name->particle = static_cast<uint32_t>(now.index());
    }
    return false;
  });
}

/// plants[plant] is gone, and those after it moved up.
inline void forget(std::vector<CachedContact>& cache, uint32_t plant) {
  std::erase_if(cache, [&](CachedContact& contact) {
    for (ParticleName* name : {&contact.pair.a, &contact.pair.b}) {
      if (name->plant == plant) return true;
      if (name->plant > plant) --name->plant;
    }
    return false;
  });
}

}  // namespace liana
