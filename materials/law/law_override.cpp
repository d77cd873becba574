#include "materials/law/law_override.h"

#include <fmt/core.h>

#include <charconv>

#include "materials/law/law_numbers.h"
#include "mesher/base/error.h"
#include "mesher/base/nearest_word.h"

namespace liana {
namespace {

std::map<std::string, double*> numbers_by_key(SpeciesLaw& law) {
  std::map<std::string, double*> numbers;
  std::string prefix;
  const auto collect = [&](const NumberRange& range, double& value) { numbers[prefix + range.key] = &value; };
  prefix = "default_material.";
  for_each_number_of_material(law.default_material, collect);
  prefix = "model.";
  for_each_number_of_model(law.model, collect);
  for (auto& [name, group] : law.groups) {
    prefix = name + ".";
    for_each_number_of_group(group, collect);
    for_each_optional_number_of_group(group, collect);
    prefix = name + ".damping.";
    for_each_number_of_damping(group.damping, collect);
  }
  return numbers;
}

}  // namespace

void set_number(SpeciesLaw& law, const std::string& assignment) {
  const size_t equals = assignment.find('=');
  if (equals == std::string::npos)
    throw Error(Error::Kind::Usage, "'" + assignment + "' sets nothing",
                "write KEY=VALUE, e.g. level0.reference_frequency=1.2");
  std::string key = assignment.substr(0, equals);
  if (key.starts_with("groups.")) key.erase(0, 7);

  const std::map<std::string, double*> numbers = numbers_by_key(law);
  const auto number = numbers.find(key);
  if (number == numbers.end()) {
    std::vector<std::string> keys;
    for (const auto& [known, value] : numbers) keys.push_back(known);
    throw Error(Error::Kind::Usage, fmt::format("species '{}' has no number '{}'", law.species, key),
                fmt::format("did you mean '{}'?", nearest_word(key, keys)));
  }
  const char* end = assignment.data() + assignment.size();
  const auto [rest, code] = std::from_chars(assignment.data() + equals + 1, end, *number->second);
  if (code != std::errc() || rest != end)
    throw Error(Error::Kind::Usage, "'" + assignment.substr(equals + 1) + "' is not a number",
                "e.g. " + key + "=0.5");
  check(law, assignment);
}

}  // namespace liana
