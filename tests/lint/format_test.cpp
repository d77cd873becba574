// Every source is as clang-format 14 with our .clang-format lays it out.
#include <gtest/gtest.h>

#include "tests/lint/source_files.h"

namespace liana::lint {
namespace {

TEST(Format, IsClangFormats) {
  output_of(
      "find mesher modal materials runtime tests -name '*.h' -o -name '*.cpp' | "
      "xargs -P 2 -n 40 clang-format-14 --dry-run -Werror 2>&1");
}

}  // namespace
}  // namespace liana::lint
