#include "materials/law/species_writer.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "materials/law/law_numbers.h"

namespace liana {
namespace {

const SourcedNumber* find(const SpeciesFile& file, const std::string& where) {
  const auto found = std::find_if(file.numbers.begin(), file.numbers.end(),
                                  [&](const SourcedNumber& n) { return n.where == where; });
  return found == file.numbers.end() ? nullptr : &*found;
}

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << toml::value<std::string>(text);
  return out.str();
}

/// A number with the source of the first of several places that has one.
std::string entry(const SpeciesFile& file, const char* key, double value,
                  const std::vector<std::string>& places) {
  const SourcedNumber* number = nullptr;
  for (const std::string& where : places)
    if (!number) number = find(file, where);
  return fmt::format("{} = {{ value = {}, source = {}, confidence = {} }}\n", key, value,
                     quoted(number ? number->source : "not given"),
                     quoted(number ? number->confidence : "guess"));
}

}  // namespace

void set_source(SpeciesFile& file, const std::string& where, const std::string& source,
                const std::string& confidence) {
  const auto found = std::find_if(file.numbers.begin(), file.numbers.end(),
                                  [&](const SourcedNumber& n) { return n.where == where; });
  if (found != file.numbers.end())
    found->source = source, found->confidence = confidence;
  else
    file.numbers.push_back({where, 0, "", source, confidence});
}

std::string species_toml(const SpeciesFile& file, std::string_view comment) {
  std::ostringstream out;
  std::istringstream lines{std::string(comment)};
  for (std::string line; std::getline(lines, line);) out << "# " << line << "\n";
  out << "\n";

  out << "name = " << quoted(file.law.species) << "\ndescription = " << quoted(file.description)
      << "\n\n[default_material]\n";
  for_each_number_of_material(file.law.default_material, [&](const NumberRange& range, double value) {
    out << entry(file, range.key, value, {std::string("default_material.") + range.key});
  });
  for (const auto& [name, law] : file.law.groups) {
    const std::string where = "groups." + name + ".";
    out << "\n[groups." << quoted(name) << "]\n";
    for_each_number_of_group(law, [&](const NumberRange& range, double value) {
      out << entry(file, range.key, value, {where + range.key, where + "c1"});
    });
    out << "\n[groups." << quoted(name) << ".damping]\n";
    for_each_number_of_damping(law.damping, [&](const NumberRange& range, double value) {
      out << entry(file, range.key, value, {where + "damping." + range.key});
    });
  }
  return out.str();
}

}  // namespace liana
