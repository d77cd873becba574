// A TOML file read strictly: every value has a range, every unknown key is an error with its line.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

/// One table of a TOML file. Readers throw Error{Input} "file:line: key ..." when a value is absent and
/// required, has the wrong type, is not finite or lies outside [least, most].
class TomlTable {
 public:
  static TomlTable read(const std::filesystem::path& path);

  bool has(const std::string& key) const;
  bool is_table(const std::string& key) const;  ///< present and a table
  double number(const std::string& key, double least, double most) const;
  double number_or(const std::string& key, double fallback, double least, double most) const;
  int64_t integer_or(const std::string& key, int64_t fallback, int64_t least, int64_t most) const;
  bool flag_or(const std::string& key, bool fallback) const;
  std::string text(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& fallback) const;
  /// [ "a", "b" ]; empty when absent.
  std::vector<std::string> texts(const std::string& key) const;
  /// Three finite numbers of magnitude at most 1e6.
  Vec3 vector(const std::string& key) const;
  Vec3 vector_or(const std::string& key, const Vec3& fallback) const;

  std::optional<TomlTable> table(const std::string& key) const;  ///< [key] or key = {...}
  std::vector<TomlTable> tables(const std::string& key) const;   ///< [[key]], in order; empty when absent
  std::vector<std::string> keys() const;

  /// Throws for the first key that no reader above has asked for, naming the nearest one that was.
  void refuse_unknown_keys() const;

  const std::filesystem::path& file() const;
  size_t line() const;  ///< where the table begins
  /// An Error{Input} at the line of the key (of the table when the key is absent).
  [[noreturn]] void fail(const std::string& key, const std::string& what, const std::string& hint = {}) const;

 private:
  struct Node;
  explicit TomlTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::shared_ptr<Node> node_;
};

}  // namespace liana
