// How full the space around a plant is: stems compete for room.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "runtime/sim/model/topology.h"

namespace liana {

/// Points in cubic cells. Answers are those of a search through all of them.
class Crowding {
 public:
  explicit Crowding(double cell) : cell_(cell) {}

  /// `x` is where a particle of a branch is.
  void add(const Vec3& x, BranchId branch, ParticleId particle) {
    cells_[key(x)].push_back({x, branch, particle});
  }

  /// The plant lost particles: they take no room any more.
  void follow(const TopologyChange& change) {
    for (auto& [cell, entries] : cells_)
      std::erase_if(entries, [&](Entry& entry) {
        entry.particle = change.particles[entry.particle.index()];
        entry.branch = change.branches[entry.branch.index()];
        return !entry.particle.valid();
      });
  }

  /// Whether a point of a branch other than `own` is within `radius` (m, at most the cell).
  bool crowded(const Vec3& x, double radius, BranchId own) const {
    const Key middle = key(x);
    for (int i = 0; i < 27; ++i) {
      const auto found =
          cells_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
      if (found == cells_.end()) continue;
      for (const Entry& entry : found->second)
        if (entry.branch != own && (entry.x - x).squaredNorm() < radius * radius) return true;
    }
    return false;
  }

  template <class Archive>
  void persist(Archive& a) {
    a(cells_);
    // not state: cell_: set once
  }

 private:
  using Key = std::array<int, 3>;
  struct Entry {
    Vec3 x;
    BranchId branch;
    ParticleId particle;

    template <class Archive>
    void persist(Archive& a) {
      a(x, branch, particle);
    }
  };
  Key key(const Vec3& x) const {
    return {static_cast<int>(std::floor(x.x() / cell_)), static_cast<int>(std::floor(x.y() / cell_)),
            static_cast<int>(std::floor(x.z() / cell_))};
  }

  double cell_;
  std::map<Key, std::vector<Entry>> cells_;
};

}  // namespace liana
