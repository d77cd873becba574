// One name, one meaning: what two translation units may not define differently under one name (the standard's
// one-definition rule, which no compiler checks).
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/lint/code_tags.h"
#include "tests/lint/source_files.h"

namespace liana::lint {
namespace {

bool is_header(const Tag& tag) {
  return tag.file.ends_with(".h");
}

// A header's anonymous namespace is one of its own in every file: as good as none for a reader.
std::string name_of(const Tag& tag) {
  return std::regex_replace(tag.qualified(), std::regex("__anon[0-9a-f]+::"), "");
}

bool in_anonymous_namespace(const Tag& tag) {
  return tag.scope.find("__anon") != std::string::npos;
}

// Operators are told apart by what they take. Types anywhere but in a source file's anonymous namespace, and
// functions that headers define.
TEST(OneDefinition, ANameIsDefinedInOneFile) {
  std::map<std::string, std::set<std::string>> files;
  for (const Tag& tag : code_tags())
    if (tag.qualified().find("operator") == std::string::npos &&
        (is_header(tag) || (tag.is_type() && !in_anonymous_namespace(tag))))
      files[name_of(tag)].insert(tag.file);
  for (const auto& [name, where] : files) {
    std::string list;
    for (const std::string& file : where) list += "\n  " + file;
    EXPECT_EQ(where.size(), 1u) << name << " is defined in" << list;
  }
}

}  // namespace
}  // namespace liana::lint
