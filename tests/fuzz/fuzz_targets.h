// The fuzz targets of this folder by name; the list is written by CMake.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace liana {

struct FuzzTarget {
  std::string name;
  int (*run)(const uint8_t* data, size_t size);
};

std::vector<FuzzTarget> fuzz_targets();

}  // namespace liana
