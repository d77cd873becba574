// The bake as a file: little-endian, versioned, with a checksum over everything.
//
//   "LIANABK\n"  u32 version  u32 zero  u64 payload bytes  u64 XXH3 of the payload  payload
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "materials/bake/bake.h"

namespace liana {

constexpr uint32_t kBakeVersion = 4;
constexpr uint32_t kOldestBakeVersion = 3;  ///< without the modulus of rupture; still read

/// Atomic: an existing file stays as it was until the new one is complete. Throws Error{Output}, or
/// Error{Input} when the bake itself breaks a rule that read_bake checks.
void write_bake(const Bake& bake, const std::filesystem::path& path);

/// Gives back what was written, bit for bit. Throws Error{Input} when the file is missing, no bake, of
/// another version, cut short, changed, or holds values that cannot be (not finite, out of range, child
/// before parent).
Bake read_bake(const std::filesystem::path& path);

/// The file's bytes; `name` stands for the file in errors.
std::string encode_bake(const Bake& bake);
Bake decode_bake(std::string_view bytes, const std::string& name);

/// Whether the bytes start like a bake of any version.
bool is_bake(std::string_view bytes);

}  // namespace liana
