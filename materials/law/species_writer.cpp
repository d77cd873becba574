#include "materials/law/species_writer.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "materials/law/law_numbers.h"
#include "materials/law/material_model.h"

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

/// Numbers that may be left out are written where they differ from what their absence means.
template <class Law, class Visit>
void for_each_other_than_default(const Law& law, Visit&& visit_all, std::ostream& out,
                                 const SpeciesFile& file, const std::string& where) {
  std::vector<double> usual;
  const Law none{};
  visit_all(none, [&](const NumberRange&, double value) { usual.push_back(value); });
  size_t i = 0;
  visit_all(law, [&](const NumberRange& range, double value) {
    if (value != usual[i++]) out << entry(file, range.key, value, {where + range.key});
  });
}

void write_model(std::ostream& out, const SpeciesFile& file) {
  out << "\n[model]\nname = " << quoted(model_name(file.law.model.model)) << "\n";
  const auto visit_all = [](const ModelLaw& law, auto&& visit) { for_each_number_of_model(law, visit); };
  for_each_other_than_default(file.law.model, visit_all, out, file, "model.");
}

void write_match(std::ostream& out, const std::string& name, const GroupMatch& match) {
  if (match.empty()) return;
  out << "\n[groups." << quoted(name) << ".match]\n";
  if (!match.name.empty()) out << "name = " << quoted(match.name) << "\n";
  if (match.kind) out << "kind = " << (*match.kind == DomainKind::Leaf ? "\"leaf\"" : "\"branch\"") << "\n";
  if (match.level >= 0) out << "level = " << match.level << "\n";
}

void write_group(std::ostream& out, const SpeciesFile& file, const std::string& name, const GroupLaw& law) {
  const std::string where = "groups." + name + ".";
  out << "\n[groups." << quoted(name) << "]\n";
  for_each_number_of_group(law, [&](const NumberRange& range, double value) {
    out << entry(file, range.key, value, {where + range.key, where + "c1"});
  });
  const auto visit_all = [](const GroupLaw& group, auto&& visit) {
    for_each_optional_number_of_group(group, visit);
  };
  for_each_other_than_default(law, visit_all, out, file, where);
  out << "\n[groups." << quoted(name) << ".damping]\n";
  for_each_number_of_damping(law.damping, [&](const NumberRange& range, double value) {
    out << entry(file, range.key, value, {where + "damping." + range.key});
  });
  write_match(out, name, law.match);
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
  write_model(out, file);
  for (const auto& [name, law] : file.law.groups) write_group(out, file, name, law);
  return out.str();
}

}  // namespace liana
