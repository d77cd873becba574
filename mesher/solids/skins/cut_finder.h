// Where a branch is cut off a skin.
#pragma once

#include <vector>

#include "mesher/solids/skins/branch_axes.h"

namespace liana {

/// Finds a cut for one branch after the other; none crosses a triangle of one before.
class CutFinder {
 public:
  explicit CutFinder(const SkinField& field) : field_(field), taken_(field.mesh.triangles.size(), 0) {}

  /// Of the plane cuts across the branch, from its crotch outward, the first that stays on it and on
  /// triangles that no other cut crosses; else a level line of the distance.
  std::optional<LevelLoop> find(const BranchAxis& axis);

 private:
  bool accept(const LevelLoop& loop, double base, double diameter);

  const SkinField& field_;
  std::vector<uint8_t> taken_;
};

}  // namespace liana
