// Which of the frequencies of the tracked points is the wind's, the trunk's, and each branch's own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "materials/video/modes/point_modes.h"

namespace liana {

/// What a tracked point sits on.
struct PointTarget {
  std::string point;
  std::string domain;  ///< of the bake; empty when group and length were given
  std::string group;   ///< "level0" (trunk), "level1", ..., "leaf"
  int level = 0;
  double length = 0;  ///< ℓ, m
};

enum class WindRule {
  Auto,    ///< the lowest frequency that the points share, below 0.5 Hz, when they share a higher one, too
  None,    ///< nothing is the wind's
  Lowest,  ///< the lowest that the points share, as [Wang17] §7
  Below,   ///< everything up to a given frequency
};

struct WindOptions {
  WindRule rule = WindRule::Auto;
  double below = 0;  ///< Hz
};

enum class ModeRole { Own, Wind, Parent, Other };
const char* name_of(ModeRole role);

struct BranchMotion {
  PointTarget target;
  PointModes motion;
  std::vector<ModeRole> roles;      ///< one per mode
  std::optional<MeasuredMode> own;  ///< the branch's own
};

struct TreeModes {
  std::vector<BranchMotion> branches;
  std::optional<MeasuredMode> wind, trunk;
  bool trunk_was_tracked = false;  ///< else the trunk's frequency is the one its branches share
  std::vector<std::string> notes;
};

/// Branches in any order. A branch's own frequency is its strongest that is neither the wind's nor that of
/// what carries it ([Wang17] §7); two frequencies agree when their 95 % intervals or half the resolution of
/// the records overlap.
TreeModes tree_modes(std::vector<BranchMotion> branches, const WindOptions& wind);

}  // namespace liana
