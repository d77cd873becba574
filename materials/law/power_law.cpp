#include "materials/law/power_law.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>

#include "materials/law/damping.h"
#include "materials/law/law_numbers.h"
#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"

namespace liana {
namespace {

/// N of "level<N>", or -1.
int level_of(const std::string& name) {
  constexpr std::string_view kPrefix = "level";
  if (!name.starts_with(kPrefix)) return -1;
  int level = -1;
  const char* end = name.data() + name.size();
  const auto [rest, code] = std::from_chars(name.data() + kPrefix.size(), end, level);
  return code == std::errc() && rest == end ? level : -1;
}

}  // namespace

double frequency_of_length(const GroupLaw& law, double length) {
  return law.reference_frequency * fixed::pow(length / law.reference_length, law.epsilon1);
}

double mass_scaling_of_length(const GroupLaw& law, double length) {
  return law.c2 * fixed::pow(length, law.epsilon2);
}

double stiffness_scaling(double mass_scaling, double frequency, double default_frequency) {
  const double ratio = frequency / default_frequency;
  return mass_scaling * ratio * ratio;
}

DomainMaterial evaluate(const GroupLaw& law, double length) {
  if (!(length > 0 && std::isfinite(length)))
    throw Error(Error::Kind::Input, fmt::format("a length of {} m has no material", length),
                "the power law needs a positive length");
  check(law, "the power law");
  return evaluate_at(law, length, frequency_of_length(law, length));
}

DomainMaterial evaluate_at(const GroupLaw& law, double length, double frequency) {
  const double factor = damping_factor(law.damping, frequency);
  const RayleighDamping rayleigh = rayleigh_damping(law.damping, frequency, factor);
  return {frequency, mass_scaling_of_length(law, length), factor, rayleigh.mass, rayleigh.stiffness};
}

double modulus_of_rupture(const SpeciesLaw& law, const std::string& group) {
  try {
    return law.group(group).modulus_of_rupture;
  } catch (const Error&) {
    return 0;
  }
}

const GroupLaw& SpeciesLaw::group(const std::string& name) const {
  if (const auto found = groups.find(name); found != groups.end()) return found->second;
  for (int level = level_of(name) - 1; level >= 0; --level) {
    const auto found = groups.find("level" + std::to_string(level));
    if (found != groups.end()) return found->second;
  }
  std::string known;
  for (const auto& [key, law] : groups) known += (known.empty() ? "" : ", ") + key;
  throw Error(
      Error::Kind::Input, fmt::format("species '{}' has no material group '{}'", species, name),
      fmt::format("it has: {}; add [groups.{}] to its file or change the group in the plant", known, name));
}

}  // namespace liana
