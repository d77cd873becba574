#include "materials/law/law_numbers.h"

#include <fmt/core.h>

#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr const char* kHint = "correct it in the species file, and bake again";

void check_number(const NumberRange& range, double value, const std::string& where) {
  const std::string problem = range_problem(range, value);
  if (!problem.empty())
    throw Error(Error::Kind::Input, fmt::format("{}: {} {}", where, range.key, problem), kHint);
}

}  // namespace

std::string range_problem(const NumberRange& range, double value) {
  if (value >= range.min && value <= range.max) return {};  // false for NaN
  return fmt::format("is {}{}{}; it must lie in [{}, {}]", value, *range.unit ? " " : "", range.unit,
                     range.min, range.max);
}

std::string damping_problem(const DampingLaw& damping) {
  if (damping.constant_rayleigh) return {};
  if (damping.low_frequency > damping.high_frequency)
    return fmt::format(
        "low_frequency {} is above high_frequency {}: swap them, and low_factor with high_factor",
        damping.low_frequency, damping.high_frequency);
  // A hair of slack: a file may hold the rounded value of 1/κ.
  const double slack = 1e-9 * damping.kappa, least = 1 / damping.kappa;
  if (damping.delta >= least - slack && damping.delta <= damping.kappa + slack) return {};
  return fmt::format(
      "delta {} would need negative damping: with kappa {} it must lie in [1/kappa, kappa] = [{}, {}]",
      damping.delta, damping.kappa, least, damping.kappa);
}

void check(const GroupLaw& law, const std::string& where) {
  const auto in_range = [&](const NumberRange& range, double value) { check_number(range, value, where); };
  for_each_number_of_group(law, in_range);
  for_each_optional_number_of_group(law, in_range);
  for_each_number_of_damping(law.damping, in_range);
  const std::string problem = damping_problem(law.damping);
  if (!problem.empty()) throw Error(Error::Kind::Input, where + ": " + problem, kHint);
}

void check(const SpeciesLaw& law, const std::string& where) {
  for_each_number_of_material(law.default_material, [&](const NumberRange& range, double value) {
    check_number(range, value, where + ": default_material");
  });
  if (law.model.model > MaterialModel::Median)
    throw Error(Error::Kind::Input, where + ": there is no such material model", kHint);
  for_each_number_of_model(law.model, [&](const NumberRange& range, double value) {
    check_number(range, value, where + ": model");
  });
  for (const auto& [name, group] : law.groups) check(group, where + ": group '" + name + "'");
  if (law.groups.empty())
    throw Error(Error::Kind::Input, where + ": no material groups", "add [groups.level0] and [groups.leaf]");
}

}  // namespace liana
