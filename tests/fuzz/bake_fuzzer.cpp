// decode_bake on any bytes, and on any payload with a header that fits it: a bake that is encoded and decoded
// to the same bytes, or an Error.
#include <optional>

#include "materials/bake/bake_file.h"
#include "materials/bake/byte_stream.h"
#include "mesher/base/error.h"
#include "mesher/base/hash.h"

namespace {

void try_bytes(std::string_view bytes) {
  std::optional<liana::Bake> bake;
  try {
    bake = liana::decode_bake(bytes, "fuzz.bake");
  } catch (const liana::Error&) {
    return;
  }
  const std::string once = liana::encode_bake(*bake);
  liana::require(liana::encode_bake(liana::decode_bake(once, "again")) == once, "reads what it writes");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (liana::is_bake(bytes)) try_bytes(bytes);
  constexpr size_t kHeaderSize = 32;
  const std::string_view payload =
      liana::is_bake(bytes) && size > kHeaderSize ? bytes.substr(kHeaderSize) : bytes;
  for (uint32_t version = liana::kOldestBakeVersion; version <= liana::kBakeVersion; ++version) {
    liana::ByteWriter header;
    for (const char letter : {'L', 'I', 'A', 'N', 'A', 'B', 'K', '\n'}) header.number(letter);
    header.number(version);
    header.number(uint32_t{0});
    header.number(static_cast<uint64_t>(payload.size()));
    header.number(liana::hash_bytes(payload.data(), payload.size()));
    try_bytes(header.bytes() + std::string(payload));
  }
  return 0;
}
