#include "materials/video/fit_law.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace liana {
namespace {

/// ξ as a straight line over ν, weighted by certainty; never below zero.
DampingLaw fit_damping(const std::vector<FittedBranch>& branches, DampingLaw law) {
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  double lowest = branches.front().measured.frequency, highest = lowest;
  for (const FittedBranch& b : branches) {
    const double weight = 1 / std::pow(std::max(b.measured.damping_sigma, 1e-4), 2), x = b.measured.frequency,
                 y = b.measured.damping_factor;
    w += weight, wx += weight * x, wy += weight * y, wxx += weight * x * x, wxy += weight * x * y;
    lowest = std::min(lowest, x), highest = std::max(highest, x);
  }
  const double determinant = w * wxx - wx * wx;
  const bool spread = highest > 1.1 * lowest && determinant > 0;
  const double slope = spread ? (w * wxy - wx * wy) / determinant : 0, middle = wx / w;
  const auto factor = [&](double x) { return std::max(0.0, wy / w + slope * (x - middle)); };
  law.constant_rayleigh = false;
  law.low_frequency = lowest, law.high_frequency = highest;
  law.low_factor = factor(lowest), law.high_factor = factor(highest);
  return law;
}

FittedGroup fit_group(const std::string& name, std::vector<FittedBranch> branches, const GroupLaw& base) {
  FittedGroup group{name, base.epsilon1, 0, 0, 0, {}, {}};
  double top = 0, bottom = 0, variance = 0;
  for (const FittedBranch& b : branches) {
    const double shape = std::pow(b.length, base.epsilon1);
    top += b.measured.frequency * shape, bottom += shape * shape;
    variance += std::pow(shape * b.measured.frequency_sigma, 2);
  }
  group.c1 = top / bottom;
  group.c1_sigma = std::sqrt(variance) / bottom;
  double squares = 0;
  for (FittedBranch& b : branches) {
    b.fitted = group.c1 * std::pow(b.length, base.epsilon1);
    squares += std::pow(b.measured.frequency - b.fitted, 2);
  }
  group.residual = std::sqrt(squares);
  group.damping = fit_damping(branches, base.damping);
  group.branches = std::move(branches);
  return group;
}

}  // namespace

std::vector<FittedGroup> fit_law(TreeModes& tree, const SpeciesLaw& base, double trunk_length) {
  std::map<std::string, std::vector<FittedBranch>> groups;
  for (const BranchMotion& branch : tree.branches)
    if (branch.own)
      groups[branch.target.group].push_back(
          {branch.target.point, branch.target.domain, branch.target.length, *branch.own, 0});
  if (tree.trunk && !tree.trunk_was_tracked) {
    if (trunk_length > 0)
      groups["level0"].push_back({"shared by the branches", "", trunk_length, *tree.trunk, 0});
    else
      tree.notes.push_back(
          "the trunk's length is not known: level0 keeps the base species' law (give --plant or "
          "--trunk-length)");
  }
  std::vector<FittedGroup> fitted;
  for (auto& [name, branches] : groups)
    fitted.push_back(fit_group(name, std::move(branches), base.group(name)));
  return fitted;
}

}  // namespace liana
