#include "materials/law/species_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

#include "materials/law/law_numbers.h"
#include "materials/law/material_model.h"
#include "materials/law/toml_table.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

constexpr std::array<const char*, 4> kConfidences = {"high", "medium", "low", "guess"};

/// Reads numbers of one table, or of a second one when the first does not give them, and keeps their sources.
class NumberReader {
 public:
  NumberReader(std::string where, TomlTable table, std::optional<TomlTable> fallback, SpeciesFile& file)
      : where_(std::move(where)), table_(std::move(table)), fallback_(std::move(fallback)), file_(file) {}

  /// Whether one of the two tables gives it.
  bool has(const NumberRange& range) const {
    const bool shared = fallback_ && fallback_->has(range.key);  // asked even when unused: it is a known key
    return table_.has(range.key) || shared;
  }

  void operator()(const NumberRange& range, double& value) const {
    const bool shared = fallback_ && fallback_->has(range.key);  // asked even when unused: it is a known key
    if (table_.has(range.key))
      value = read(table_, range);
    else if (shared)
      value = read(*fallback_, range);
    else
      table_.fail(where_ + "." + range.key, "is missing",
                  "give it as { value = ..., source = \"...\", confidence = \"high|medium|low|guess\" }");
  }

 private:
  double read(const TomlTable& table, const NumberRange& range) const {
    if (!table.is_table(range.key))
      table.fail(range.key, "has no source",
                 fmt::format(
                     "write {} = {{ value = ..., source = \"...\", confidence = \"high|medium|low|guess\" }}",
                     range.key));
    const TomlTable entry = *table.table(range.key);
    constexpr double kAny = std::numeric_limits<double>::infinity();
    const double value = entry.number("value", -kAny, kAny);
    const std::string problem = range_problem(range, value);
    if (!problem.empty()) table.fail(range.key, problem);
    const std::string source = entry.text("source"), confidence = entry.text("confidence");
    if (source.empty())
      entry.fail("source", "is empty", "say where the number comes from, or that it is a guess");
    if (std::find(kConfidences.begin(), kConfidences.end(), confidence) == kConfidences.end())
      entry.fail("confidence", "must be \"high\", \"medium\", \"low\" or \"guess\"");
    entry.refuse_unknown_keys();
    file_.numbers.push_back({where_ + "." + range.key, value, range.unit, source, confidence});
    return value;
  }

  std::string where_;
  TomlTable table_;
  std::optional<TomlTable> fallback_;
  SpeciesFile& file_;
};

TomlTable required_table(const TomlTable& table, const std::string& key) {
  std::optional<TomlTable> child = table.table(key);
  if (!child) table.fail(key, "is missing", "see the other files in data/species for the layout");
  return *child;
}

/// [every_group] and [every_group.damping], each opened once so that it knows which of its keys were asked
/// for.
struct SharedTables {
  std::optional<TomlTable> group, damping;
};

/// Whether d_M and d_K are given rather than ξ(ν). A group's own table decides before what all groups share.
bool is_constant(const TomlTable& own, const std::optional<TomlTable>& shared) {
  const auto constant = [](const TomlTable& table) {
    return table.has("mass_damping") || table.has("stiffness_damping");
  };
  if (constant(own)) {
    for (const char* key : {"low_factor", "high_factor"})
      if (own.has(key))
        own.fail(key, "is given beside mass_damping or stiffness_damping", "give one of the two forms");
    return true;
  }
  return own.keys().empty() && shared && constant(*shared);
}

GroupMatch read_match(const TomlTable& group) {
  GroupMatch match;
  const std::optional<TomlTable> table = group.table("match");
  if (!table) return match;
  match.name = table->text_or("name", "");
  const std::string kind = table->text_or("kind", "");
  if (kind == "branch" || kind == "leaf")
    match.kind = kind == "leaf" ? DomainKind::Leaf : DomainKind::Branch;
  else if (!kind.empty())
    table->fail("kind", "must be \"branch\" or \"leaf\"");
  match.level = static_cast<int>(table->integer_or("level", -1, 0, 1000));
  table->refuse_unknown_keys();
  if (match.empty())
    group.fail("match", "matches nothing",
               "give one or more of name = \"frond*\", kind = \"branch\", level = 1");
  return match;
}

ModelLaw read_model(const TomlTable& root, SpeciesFile& file) {
  ModelLaw law;
  const std::optional<TomlTable> table = root.table("model");
  if (!table) return law;
  if (table->has("name")) {
    const std::string name = table->text("name"), problem = model_name_problem(name);
    if (!problem.empty()) table->fail("name", problem);
    law.model = model_named(name);
  }
  const NumberReader read("model", *table, std::nullopt, file);
  for_each_number_of_model(law, [&](const NumberRange& range, double& value) {
    if (read.has(range)) read(range, value);
  });
  table->refuse_unknown_keys();
  return law;
}

DampingLaw read_damping(const std::string& where, const TomlTable& group,
                        const std::optional<TomlTable>& shared, SpeciesFile& file) {
  const std::optional<TomlTable> own = group.table("damping");
  if (!own && !shared) group.fail("damping", "is missing", "add [" + where + ".damping]");
  DampingLaw law;
  law.constant_rayleigh = is_constant(own ? *own : *shared, shared);
  const NumberReader read(where + ".damping", own ? *own : *shared, shared, file);
  for_each_number_of_damping(law, read);
  DampingLaw other;  // the form not taken: its shared keys are known, though not used here
  other.constant_rayleigh = !law.constant_rayleigh;
  for_each_number_of_damping(other, [&](const NumberRange& range, double&) {
    if (shared) shared->has(range.key);
  });
  if (own) own->refuse_unknown_keys();
  const std::string problem = damping_problem(law);
  if (!problem.empty()) group.fail("damping", problem);
  return law;
}

GroupLaw read_group(const std::string& where, const TomlTable& table, const SharedTables& shared,
                    SpeciesFile& file) {
  GroupLaw law;
  const NumberReader read(where, table, shared.group, file);
  const bool has_reference = table.has("reference_frequency") || table.has("reference_length");
  const bool shared_c1 = shared.group && shared.group->has("c1");
  const bool has_c1 = table.has("c1") || (shared_c1 && !has_reference);
  if (table.has("c1") && has_reference)
    table.fail("c1", "is given beside reference_frequency or reference_length", "give one of the two forms");
  for_each_number_of_group(law, [&](const NumberRange& range, double& value) {
    const bool replaced = has_c1 && std::string_view(range.key).starts_with("reference_");
    if (!replaced) return read(range, value);
    if (shared.group) shared.group->has(range.key);  // a known key, though not used here
    value = 1;
  });
  if (has_c1) read({"c1", "Hz·m^-epsilon1", 1e-3, 1e3}, law.reference_frequency);
  for_each_optional_number_of_group(law, [&](const NumberRange& range, double& value) {
    if (read.has(range)) read(range, value);
  });
  law.match = read_match(table);
  law.damping = read_damping(where, table, shared.damping, file);
  table.refuse_unknown_keys();
  return law;
}

}  // namespace

SpeciesFile read_species_file(const std::filesystem::path& path) {
  SpeciesFile file;
  file.path = path;
  const std::string bytes = read_file(path, size_t{1} << 20);
  file.hash = hash_bytes(bytes.data(), bytes.size());

  const TomlTable root = TomlTable::read(path);
  file.law.species = root.text("name");
  file.description = root.text_or("description", "");
  const TomlTable material = required_table(root, "default_material");
  for_each_number_of_material(file.law.default_material,
                              NumberReader("default_material", material, std::nullopt, file));
  material.refuse_unknown_keys();

  file.law.model = read_model(root, file);
  SharedTables shared{root.table("every_group"), std::nullopt};
  if (shared.group) shared.damping = shared.group->table("damping");
  const TomlTable groups = required_table(root, "groups");
  for (const std::string& name : groups.keys())
    file.law.groups[name] = read_group("groups." + name, required_table(groups, name), shared, file);
  if (file.law.groups.empty()) root.fail("groups", "is empty", "add [groups.level0] and [groups.leaf]");
  for (const auto& table : {shared.damping, shared.group})
    if (table) table->refuse_unknown_keys();
  root.refuse_unknown_keys();
  return file;
}

SpeciesLaw read_species(const std::string& name_or_path) {
  return read_species_file(find_species(name_or_path)).law;
}

}  // namespace liana
