// Every folder says what comes in and what goes out: in a README of its own, or in a table of one above it.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "tests/lint/source_files.h"

namespace liana::lint {
namespace {
namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::set<fs::path> folders_with_files() {
  std::set<fs::path> folders;
  for (const char* name : {"mesher", "modal", "materials", "runtime", "tests", "data"})
    for (const auto& entry : fs::recursive_directory_iterator(top() / name))
      if (entry.is_regular_file()) folders.insert(fs::relative(entry.path().parent_path(), top()));
  return folders;
}

/// Is `folder` named as `path/` in a README above it?
bool named_above(const fs::path& folder) {
  for (fs::path above = folder.parent_path(); !above.empty(); above = above.parent_path()) {
    const fs::path readme = top() / above / "README.md";
    const std::string name = fs::relative(folder, above).string() + "/";
    if (fs::exists(readme) && text_of(readme).find(name) != std::string::npos) return true;
  }
  return false;
}

TEST(Readme, EveryFolderSaysWhatComesInAndGoesOut) {
  for (const fs::path& folder : folders_with_files()) {
    if (folder.string().rfind("tests/fuzz/corpus/", 0) == 0) continue;
    EXPECT_TRUE(fs::exists(top() / folder / "README.md") || named_above(folder)) << folder;
  }
}

// A table that names folders says what they take and give.
TEST(Readme, TopFoldersHaveATableOfInAndOut) {
  for (const char* folder : {"mesher", "modal", "materials", "runtime"}) {
    const std::string text = text_of(top() / folder / "README.md");
    EXPECT_NE(text.find("| comes in | goes out"), std::string::npos) << folder;
  }
}

}  // namespace
}  // namespace liana::lint
