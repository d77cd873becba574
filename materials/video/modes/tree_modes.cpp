#include "materials/video/modes/tree_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace liana {
namespace {

constexpr double kFastestWind = 0.5;  // Hz: gusts come every 2 s or slower

bool agree(const MeasuredMode& a, const MeasuredMode& b, double resolution) {
  const double interval = kCoverage95 * std::hypot(a.frequency_sigma, b.frequency_sigma);
  return std::abs(a.frequency - b.frequency) < std::max(interval, 0.5 * resolution);
}

/// The mean of what several points saw of one oscillation, weighted by certainty.
MeasuredMode mean_of(const std::vector<MeasuredMode>& seen) {
  double weights = 0, damping_weights = 0;
  MeasuredMode mean;
  for (const MeasuredMode& m : seen) {
    const double w = 1 / std::pow(m.frequency_sigma, 2), d = 1 / std::pow(m.damping_sigma, 2);
    weights += w, damping_weights += d;
    mean.frequency += w * m.frequency;
    mean.damping_factor += d * m.damping_factor;
    mean.amplitude = std::max(mean.amplitude, m.amplitude);
  }
  mean.frequency /= weights;
  mean.damping_factor /= damping_weights;
  mean.frequency_sigma = std::sqrt(1 / weights);
  mean.damping_sigma = std::sqrt(1 / damping_weights);
  return mean;
}

/// Oscillations that more than half of the points see (two at least), the slowest first.
std::vector<MeasuredMode> shared_modes(const std::vector<BranchMotion>& branches) {
  std::vector<MeasuredMode> shared;
  for (const BranchMotion& one : branches)
    for (const MeasuredMode& mode : one.motion.modes) {
      std::vector<MeasuredMode> seen;
      for (const BranchMotion& other : branches)
        for (const MeasuredMode& candidate : other.motion.modes)
          if (agree(mode, candidate, std::max(one.motion.resolution, other.motion.resolution))) {
            seen.push_back(candidate);
            break;
          }
      const bool known = std::any_of(shared.begin(), shared.end(), [&](const MeasuredMode& s) {
        return agree(s, mode, one.motion.resolution);
      });
      if (!known && seen.size() >= 2 && 2 * seen.size() > branches.size()) shared.push_back(mean_of(seen));
    }
  std::sort(shared.begin(), shared.end(),
            [](const MeasuredMode& a, const MeasuredMode& b) { return a.frequency < b.frequency; });
  return shared;
}

std::optional<MeasuredMode> wind_of(const std::vector<MeasuredMode>& shared, const WindOptions& options) {
  if (shared.empty()) return std::nullopt;
  const MeasuredMode& lowest = shared.front();
  switch (options.rule) {
    case WindRule::None:
      return std::nullopt;
    case WindRule::Lowest:
      return lowest;
    case WindRule::Below:
      return lowest.frequency <= options.below ? std::optional(lowest) : std::nullopt;
    case WindRule::Auto:
      break;
  }
  return shared.size() > 1 && lowest.frequency < kFastestWind ? std::optional(lowest) : std::nullopt;
}

void mark(BranchMotion& branch, const std::optional<MeasuredMode>& mode, ModeRole role) {
  if (!mode) return;
  for (size_t i = 0; i < branch.roles.size(); ++i)
    if (branch.roles[i] == ModeRole::Other && agree(branch.motion.modes[i], *mode, branch.motion.resolution))
      branch.roles[i] = role;
}

void choose_own(BranchMotion& branch) {
  for (size_t i = 0; i < branch.roles.size(); ++i)
    if (branch.roles[i] == ModeRole::Other) {  // the strongest comes first
      branch.roles[i] = ModeRole::Own;
      branch.own = branch.motion.modes[i];
      return;
    }
}

}  // namespace

const char* name_of(ModeRole role) {
  switch (role) {
    case ModeRole::Own:
      return "own";
    case ModeRole::Wind:
      return "wind";
    case ModeRole::Parent:
      return "parent";
    case ModeRole::Other:
      break;
  }
  return "other";
}

TreeModes tree_modes(std::vector<BranchMotion> branches, const WindOptions& options) {
  TreeModes tree;
  std::stable_sort(branches.begin(), branches.end(), [](const BranchMotion& a, const BranchMotion& b) {
    return a.target.level < b.target.level;
  });
  const std::vector<MeasuredMode> shared = shared_modes(branches);
  tree.wind = wind_of(shared, options);
  for (BranchMotion& branch : branches) {
    branch.roles.assign(branch.motion.modes.size(), ModeRole::Other);
    mark(branch, tree.wind, ModeRole::Wind);
    // Gusts are no single frequency: what is slower than theirs is theirs, too.
    double slowest = options.rule == WindRule::Below ? options.below : 0;
    if (tree.wind) slowest = std::max(slowest, tree.wind->frequency);
    for (size_t i = 0; i < branch.roles.size(); ++i)
      if (branch.motion.modes[i].frequency <= slowest) branch.roles[i] = ModeRole::Wind;
  }

  std::vector<MeasuredMode> of_trunk;
  for (BranchMotion& branch : branches)
    if (branch.target.level == 0) {
      choose_own(branch);
      if (branch.own) of_trunk.push_back(*branch.own);
    }
  tree.trunk_was_tracked = !of_trunk.empty();
  if (tree.trunk_was_tracked) {
    tree.trunk = mean_of(of_trunk);
  } else {
    for (const MeasuredMode& mode : shared) {
      if (tree.wind && mode.frequency <= tree.wind->frequency) continue;
      if (options.rule == WindRule::Below && mode.frequency <= options.below) continue;
      // Branches of one length swing alike, too: the trunk's is a frequency below which none of theirs lies.
      const bool has_above = std::any_of(branches.begin(), branches.end(), [&](const BranchMotion& b) {
        return std::any_of(b.motion.modes.begin(), b.motion.modes.end(), [&](const MeasuredMode& m) {
          return m.frequency > mode.frequency && !agree(m, mode, b.motion.resolution);
        });
      });
      if (has_above) tree.trunk = mode;
      break;
    }
  }
  for (size_t i = 0; i < branches.size(); ++i) {
    BranchMotion& branch = branches[i];
    if (branch.target.level == 0) continue;
    mark(branch, tree.trunk, ModeRole::Parent);
    for (size_t j = 0; j < i; ++j)
      if (branches[j].target.level > 0 && branches[j].target.level < branch.target.level)
        mark(branch, branches[j].own, ModeRole::Parent);
    choose_own(branch);
  }
  for (const BranchMotion& branch : branches)
    if (!branch.own)
      tree.notes.push_back(
          fmt::format("point '{}' shows only frequencies of the wind or of what carries it: {} is left out",
                      branch.target.point, branch.target.group));
  tree.branches = std::move(branches);
  return tree;
}

}  // namespace liana
