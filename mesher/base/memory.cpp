#include "mesher/base/memory.h"

#include <fmt/core.h>

#include <fstream>
#include <limits>

#include "mesher/base/error.h"

namespace liana {

size_t available_memory() {
  std::ifstream in("/proc/meminfo");
  std::string key, unit;
  size_t kilobytes = 0;
  while (in >> key >> kilobytes && std::getline(in, unit))
    if (key == "MemAvailable:") return kilobytes * 1024;
  return std::numeric_limits<size_t>::max();
}

void require_memory(size_t bytes, const std::string& what) {
  constexpr size_t kAlwaysThere = size_t{64} << 20;  // not worth asking
  if (bytes <= kAlwaysThere) return;
  const size_t available = available_memory();
  if (bytes <= available) return;
  throw Error(Error::Kind::Input,
              fmt::format("{} needs about {:.1f} GB of memory, and {:.1f} GB are free", what,
                          1e-9 * double(bytes), 1e-9 * double(available)),
              "simplify the mesh in a modelling tool, split the plant, or use a machine with more memory");
}

}  // namespace liana
