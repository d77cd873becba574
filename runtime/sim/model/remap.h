// Slots of a plant's arrays after it lost particles: one table per removal, kept by the plant until every
// cache of slots has taken it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mesher/base/error.h"
#include "mesher/base/types.h"

namespace liana {

/// Old slot → new slot, invalid for what is gone. What stays keeps its order.
struct Remap {
  std::vector<ParticleId> particles;
  std::vector<BranchId> branches;
  std::vector<BranchId> shortened;  ///< new slots of branches that lost their upper part

  ParticleId operator()(ParticleId old) const { return particles[old.index()]; }
  BranchId operator()(BranchId old) const { return branches[old.index()]; }
  bool was_shortened(BranchId now) const {
    return std::find(shortened.begin(), shortened.end(), now) != shortened.end();
  }

  /// Moves an array with one value per particle (or only for the first ones).
  template <class T, class Allocator>
  void keep_particles(std::vector<T, Allocator>& values) const {
    keep(values, particles);
  }
  template <class T, class Allocator>
  void keep_branches(std::vector<T, Allocator>& values) const {
    keep(values, branches);
  }

  /// Appends a later removal. Its tables may be longer: of what was born in between.
  void then(const Remap& next);

  template <class Archive>
  void persist(Archive& a) {
    a(particles, branches, shortened);
  }

 private:
  template <class Values, class Slots>
  static void keep(Values& values, const Slots& now) {
    size_t kept = 0;
    for (size_t i = 0; i < values.size() && i < now.size(); ++i)
      if (now[i].valid()) values[kept++] = values[i];
    values.resize(kept);
  }
};

/// The removals of one plant. The epoch is how many there ever were.
class RemapLog {
 public:
  uint64_t epoch() const { return dropped_ + removals_.size(); }
  const Remap& last() const { return removals_.back(); }

  void add(Remap removal) { removals_.push_back(std::move(removal)); }
  /// All removals since an epoch as one. `since` must not be before the last clear().
  Remap since(uint64_t epoch) const;
  /// Every cache has taken them.
  void clear() {
    dropped_ += removals_.size();
    removals_.clear();
  }

  template <class Archive>
  void persist(Archive& a) {
    a(removals_, dropped_);
  }

 private:
  friend class SlotCache;
  std::vector<Remap> removals_;
  uint64_t dropped_ = 0;
};

/// At which epoch the slots are that somebody remembers of a plant.
class SlotCache {
 public:
  /// Brings them up to date: calls follow(const Remap&) with the table since the last call, if there is one.
  /// Before a plant's removals are taken for the first time nothing may be remembered of it.
  template <class Follow>
  void take(const RemapLog& log, const Follow& follow) {
    const uint64_t now = log.epoch();
    if (epoch_ != kFresh && epoch_ != now) {
      require(epoch_ >= log.dropped_, "a cache of slots took every removal");
      if (epoch_ + 1 == now)
        follow(log.last());
      else
        follow(log.since(epoch_));
    }
    epoch_ = now;
  }

  /// In debug builds: that nobody uses slots of another epoch.
  void check([[maybe_unused]] const RemapLog& log) const {
#ifndef NDEBUG
    require(epoch_ == log.epoch(), "a cache of slots is used before it took the last removal");
#endif
  }

  template <class Archive>
  void persist(Archive& a) {
    a(epoch_);
  }

 private:
  static constexpr uint64_t kFresh = ~uint64_t{0};
  uint64_t epoch_ = kFresh;
};

}  // namespace liana
