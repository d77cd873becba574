#include "materials/cache/program_identity.h"

#include <link.h>

#include <filesystem>

#include "mesher/base/files.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

int add_library(dl_phdr_info* info, size_t, void* hash) {
  const fs::path path = info->dlpi_name;
  std::error_code code;
  if (!fs::is_regular_file(path, code)) return 0;  // the program itself, the kernel's page
  const int64_t facts[2] = {static_cast<int64_t>(fs::file_size(path, code)),
                            fs::last_write_time(path, code).time_since_epoch().count()};
  const std::string name = path.string();
  uint64_t& sum = *static_cast<uint64_t*>(hash);
  sum = hash_bytes(facts, sizeof facts, hash_bytes(name.data(), name.size(), sum));
  return 0;
}

uint64_t identify() {
  const std::string program = read_file("/proc/self/exe", SIZE_MAX);
  uint64_t hash = hash_bytes(program.data(), program.size());
  dl_iterate_phdr(add_library, &hash);
  return hash;
}

}  // namespace

uint64_t program_identity() {
  static const uint64_t identity = identify();
  return identity;
}

}  // namespace liana
