// A function fits a screen, a class a head, a folder a glance.
#include <gtest/gtest.h>

#include <map>

#include "tests/lint/code_tags.h"
#include "tests/lint/source_files.h"

namespace liana::lint {
namespace {
namespace fs = std::filesystem;

constexpr int kFunctionLines = 60, kClassLines = 300, kFolderFiles = 25;

TEST(Sizes, DefinitionsAreFound) {
  EXPECT_GT(code_tags().size(), 2000u);
}

TEST(Sizes, FunctionsHaveSixtyLinesAtMost) {
  for (const Tag& tag : code_tags())
    if (tag.kind == "function") {
      EXPECT_LE(tag.lines(), kFunctionLines) << tag.file << ":" << tag.first << " " << tag.qualified();
    }
}

bool inside(const Tag& member, const Tag& type) {
  return member.file == type.file && member.first >= type.first && member.last <= type.last;
}

// The lines of its body and of all its members that are defined elsewhere.
TEST(Sizes, ClassesHaveThreeHundredLinesAtMost) {
  std::map<std::string, std::vector<const Tag*>> types;
  std::map<const Tag*, int> lines;
  for (const Tag& tag : code_tags())
    if (tag.is_type()) types[tag.qualified()].push_back(&tag), lines[&tag] = tag.lines();
  for (const Tag& tag : code_tags()) {
    const auto owners = types.find(tag.scope);
    if (tag.kind != "function" || owners == types.end()) continue;
    for (const Tag* owner : owners->second)
      if (!inside(tag, *owner)) lines[owner] += tag.lines();
  }
  for (const auto& [type, count] : lines)
    EXPECT_LE(count, kClassLines) << type->file << ":" << type->first << " " << type->qualified();
}

// Corpora are data.
TEST(Sizes, FoldersHaveTwentyFiveFilesAtMost) {
  std::map<std::string, int> count;
  for (const char* folder : {"mesher", "modal", "materials", "runtime", "tests", "cmake"})
    for (const auto& entry : fs::recursive_directory_iterator(top() / folder))
      if (entry.is_regular_file()) ++count[fs::relative(entry.path().parent_path(), top()).string()];
  for (const auto& [folder, files] : count)
    if (folder.rfind("tests/fuzz/corpus", 0) != 0) {
      EXPECT_LE(files, kFolderFiles) << folder;
    }
}

}  // namespace
}  // namespace liana::lint
