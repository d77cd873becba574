// Whole files: read with a clear error, written so that a failure leaves the old file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace liana {

/// Throws Error{Input} naming the path when it is missing, a folder, unreadable or above max_bytes.
std::string read_file(const std::filesystem::path& path, size_t max_bytes = size_t{4} << 30);

/// A file that appears under its own name only when complete: write to partial(), then commit(). Without
/// commit() the destructor removes what was written.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();
  /// Beside the final path and with the same extension (libraries choose the format by it).
  const std::filesystem::path& partial() const { return partial_; }
  void commit();  ///< flush to disk and rename; throws Error{Output}

 private:
  std::filesystem::path path_, partial_;
};

/// AtomicFile in one call. Throws Error{Output}.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace liana
