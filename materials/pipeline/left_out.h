// Which domains a bake leaves out, and who carries what grew on them.
#pragma once

#include <string>
#include <vector>

#include "mesher/plant/segmented_plant.h"

namespace liana {

class LeftOut {
 public:
  explicit LeftOut(size_t domains) : reasons_(domains) {}

  /// reasons: per domain, empty for those that stay. Returns whether one is left out that was in before.
  bool add(const std::vector<std::string>& reasons);

  bool has(DomainId domain) const { return !reasons_[domain.index()].empty(); }
  const std::string& reason(DomainId domain) const { return reasons_[domain.index()]; }
  std::vector<DomainId> remaining() const;
  /// The nearest ancestor that stays; invalid when there is none.
  DomainId parent_of(const SegmentedPlant& plant, DomainId domain) const;

  /// Throws Error{Input} when none remains or, with strict, naming the first that is left out.
  void refuse(const SegmentedPlant& plant, bool strict) const;
  /// The reason, and where its children attach now.
  std::string describe(const SegmentedPlant& plant, DomainId domain) const;

 private:
  std::vector<std::string> reasons_;  // empty: it stays
};

}  // namespace liana
