// What the fuzzers found worth keeping, and the seeds they start from, replayed without libFuzzer: a crash, a
// hang or an exception other than Error ends the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/fuzz_targets.h"

namespace liana {
namespace {
namespace fs = std::filesystem;

std::vector<fs::path> corpus(const std::string& name) {
  std::vector<fs::path> files;
  if (fs::is_directory(fs::path(LIANA_CORPUS) / name))
    for (const auto& entry : fs::directory_iterator(fs::path(LIANA_CORPUS) / name))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<uint8_t> bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Corpus : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Corpus, IsSurvived) {
  const std::vector<fs::path> files = corpus(GetParam().name);
  EXPECT_FALSE(files.empty()) << "tests/fuzz/corpus/" << GetParam().name << " holds no input";
  for (const fs::path& path : files) {
    SCOPED_TRACE(path.string());
    const std::vector<uint8_t> bytes = bytes_of(path);
    EXPECT_NO_THROW(GetParam().run(bytes.data(), bytes.size()));
  }
}

/// Every input cut short: what a broken download looks like.
TEST_P(Corpus, IsSurvivedWhenCutShort) {
  const size_t cuts = GetParam().name == "repair_ladder" ? 2 : 16;  // each of its inputs takes up to a second
  for (const fs::path& path : corpus(GetParam().name)) {
    SCOPED_TRACE(path.string());
    const std::vector<uint8_t> bytes = bytes_of(path);
    if (bytes.size() > 4096) continue;  // seconds, not minutes
    for (size_t parts = 0; parts < cuts; ++parts)
      EXPECT_NO_THROW(GetParam().run(bytes.data(), bytes.size() * parts / cuts));
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(fuzz_targets()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace liana
