// Writes a plant to time the offline stage on: make_plant branches 30000 FILE.glb, make_plant palm FILE.glb
#include <fmt/core.h>

#include <cstdlib>
#include <string>

#include "tests/support/plants/large_plants.h"

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  if (kind == "branches" && argc == 4 && std::atoi(argv[2]) > 0) {
    liana::write_instanced_plant(liana::make_branch_hierarchy(std::atoi(argv[2])), argv[3]);
  } else if (kind == "palm" && argc == 3) {
    liana::write_instanced_plant(liana::make_palm(), argv[2]);
  } else {
    fmt::print(stderr, "make_plant branches COUNT FILE.glb | make_plant palm FILE.glb\n");
    return 2;
  }
  return 0;
}
