#include "materials/law/toml_table.h"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <cmath>
#include <set>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/nearest_word.h"

namespace liana {

struct TomlTable::Node {
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table;
  std::filesystem::path file;
  mutable std::set<std::string> asked;
};

TomlTable TomlTable::read(const std::filesystem::path& path) {
  const std::string text = read_file(path, size_t{16} << 20);
  try {
    auto root = std::make_shared<const toml::table>(toml::parse(std::string_view(text), path.string()));
    return TomlTable(std::make_shared<Node>(Node{root, root.get(), path, {}}));
  } catch (const toml::parse_error& error) {
    throw Error(Error::Kind::Input,
                fmt::format("{}:{}: {}", path.string(), error.source().begin.line, error.description()),
                "this must be a TOML text file; see data/scenes and data/species for examples");
  }
}

void TomlTable::fail(const std::string& key, const std::string& what, const std::string& hint) const {
  const toml::node* at = node_->table->get(key);
  const auto line = (at ? at->source() : node_->table->source()).begin.line;
  throw Error(Error::Kind::Input, fmt::format("{}:{}: '{}' {}", node_->file.string(), line, key, what), hint);
}

bool TomlTable::has(const std::string& key) const {
  node_->asked.insert(key);
  return node_->table->contains(key);
}

bool TomlTable::is_table(const std::string& key) const {
  return has(key) && node_->table->get(key)->is_table();
}

double TomlTable::number(const std::string& key, double least, double most) const {
  if (!has(key)) fail(key, "is missing");
  const auto value = node_->table->get(key)->value<double>();
  if (!value) fail(key, "must be a number");
  if (!(*value >= least && *value <= most))
    fail(key, fmt::format("is {}; it must lie in [{}, {}]", *value, least, most));
  return *value;
}

double TomlTable::number_or(const std::string& key, double fallback, double least, double most) const {
  return has(key) ? number(key, least, most) : fallback;
}

int64_t TomlTable::integer_or(const std::string& key, int64_t fallback, int64_t least, int64_t most) const {
  if (!has(key)) return fallback;
  const double value = number(key, static_cast<double>(least), static_cast<double>(most));
  if (value != std::floor(value)) fail(key, "must be a whole number");
  return static_cast<int64_t>(value);
}

bool TomlTable::flag_or(const std::string& key, bool fallback) const {
  if (!has(key)) return fallback;
  const auto value = node_->table->get(key)->value<bool>();
  if (!value) fail(key, "must be true or false");
  return *value;
}

std::string TomlTable::text(const std::string& key) const {
  if (!has(key)) fail(key, "is missing");
  const auto value = node_->table->get(key)->value<std::string>();
  if (!value) fail(key, "must be a text in quotes");
  return *value;
}

std::string TomlTable::text_or(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}

std::vector<std::string> TomlTable::texts(const std::string& key) const {
  std::vector<std::string> texts;
  if (!has(key)) return texts;
  const toml::array* array = node_->table->get(key)->as_array();
  if (!array) fail(key, "must be a list of texts, [\"a\", \"b\"]");
  for (const toml::node& element : *array) {
    const auto value = element.value<std::string>();
    if (!value) fail(key, "must be a list of texts, [\"a\", \"b\"]");
    texts.push_back(*value);
  }
  return texts;
}

Vec3 TomlTable::vector(const std::string& key) const {
  if (!has(key)) fail(key, "is missing");
  const toml::array* array = node_->table->get(key)->as_array();
  if (!array || array->size() != 3) fail(key, "must be three numbers, [x, y, z]");
  Vec3 vector;
  for (size_t i = 0; i < 3; ++i) {
    const auto value = array->get(i)->value<double>();
    if (!value || !(std::abs(*value) <= 1e6)) fail(key, "must be three finite numbers, [x, y, z]");
    vector[static_cast<Eigen::Index>(i)] = *value;
  }
  return vector;
}

Vec3 TomlTable::vector_or(const std::string& key, const Vec3& fallback) const {
  return has(key) ? vector(key) : fallback;
}

std::optional<TomlTable> TomlTable::table(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  const toml::table* child = node_->table->get(key)->as_table();
  if (!child) fail(key, "must be a table");
  return TomlTable(std::make_shared<Node>(Node{node_->root, child, node_->file, {}}));
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) const {
  std::vector<TomlTable> children;
  if (!has(key)) return children;
  const toml::array* array = node_->table->get(key)->as_array();
  if (!array) fail(key, fmt::format("must be given as [[{}]]", key));
  for (const toml::node& child : *array) {
    if (!child.is_table()) fail(key, fmt::format("must be given as [[{}]]", key));
    children.push_back(
        TomlTable(std::make_shared<Node>(Node{node_->root, child.as_table(), node_->file, {}})));
  }
  return children;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : *node_->table) names.emplace_back(key.str());
  return names;
}

void TomlTable::refuse_unknown_keys() const {
  for (const std::string& key : keys()) {
    if (node_->asked.contains(key)) continue;
    const std::vector<std::string> known(node_->asked.begin(), node_->asked.end());
    fail(key, "is not known here", fmt::format("did you mean '{}'?", nearest_word(key, known)));
  }
}

const std::filesystem::path& TomlTable::file() const {
  return node_->file;
}

size_t TomlTable::line() const {
  return node_->table->source().begin.line;
}

}  // namespace liana
