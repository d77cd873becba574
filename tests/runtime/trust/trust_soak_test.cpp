// Soak: random abuse for as long as LIANA_SOAK_SECONDS (simulated) says, a few seconds by default.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "tests/support/plants/abused_garden.h"

namespace liana {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // keeps freed memory aside
#else
constexpr bool kSanitized = false;
#endif

double resident_megabytes() {
  long total = 0, resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld %ld", &total, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

TEST(Soak, AbusedGardenStaysFiniteBoundedAndOfOneSize) {
  const char* wanted = std::getenv("LIANA_SOAK_SECONDS");
  const double seconds = wanted ? std::atof(wanted) : 30;
  test::AbusedGarden garden(17, 4, 2);
  double settled = 0;
  while (garden.report().seconds < seconds) {
    garden.spell();
    ASSERT_EQ(garden.report().broken, "");
    if (settled == 0 && garden.report().seconds > seconds / 4) settled = resident_megabytes();
  }
  const test::GardenReport& r = garden.report();
  const double grown = resident_megabytes() - settled;
  std::printf(
      "%.0f s, %zu steps, %zu redone, %zu joints projected, %zu cuts; top speed %.0f m/s, energy in rest at "
      "most %.3f "
      "of its start; memory %.1f MB, grown by %.2f MB\n",
      r.seconds, r.steps, r.redone, r.projected, r.cuts, r.top_speed, r.top_growth, settled + grown, grown);
  EXPECT_EQ(r.lost, 0u);
  EXPECT_GT(r.redone, 0u) << "the abuse is real";
  EXPECT_GT(r.cuts, 0u);
  // Stacks, arenas and buffers of the largest piece so far: a leak of one cut limb (20 kB) a spell would be 4
  // MB in ten minutes.
  if (!kSanitized) {
    EXPECT_LT(grown, 3);
  }
}

}  // namespace
}  // namespace liana
