// read_manifest on any bytes: plants with absolute paths and outputs of their own, or an Error. The first
// line, taken as --shard, is a part of the whole or an Error.
#include <set>

#include "mesher/base/error.h"
#include "runtime/app/bake/manifest.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const liana::Shard shard = liana::parse_shard(text.substr(0, text.find('\n')));
    size_t held = 0;
    for (size_t i = 0; i < 100; ++i) held += shard.has(i);
    liana::require(shard.index >= 1 && shard.index <= shard.count, "a part of the whole");
    liana::require(held <= 100 / shard.count + 1, "a fair share");
  } catch (const liana::Error&) {
  }
  try {
    std::set<std::filesystem::path> outputs;
    for (const liana::ManifestItem& item :
         liana::read_manifest(liana::FuzzFile(data, size, "fuzz.toml").path())) {
      liana::require(item.plant.is_absolute() && item.output.is_absolute(), "absolute paths");
      liana::require(!item.species.empty() && item.line > 0, "a species and a line");
      liana::require(outputs.insert(item.output).second, "an output of its own");
    }
  } catch (const liana::Error&) {
  }
  return 0;
}
