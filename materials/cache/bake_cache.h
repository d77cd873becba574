// What a bake had to compute, kept for the next bake of the same plant.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace liana {

/// One file of entries, bytes by 64-bit key. Keys are hashes of everything an entry depends on, so the file's
/// name only groups what is used together; entries of another program are never seen, as it may compute
/// differently. The file is written whole or not at all, and several processes may use it at once: the last
/// one's stays. Thread-safe but for save().
class BakeCache {
 public:
  /// Reads the file if there is one; a damaged one counts as empty.
  explicit BakeCache(std::filesystem::path file);

  /// The bytes live as long as the cache.
  std::optional<std::string_view> find(uint64_t key);
  void put(uint64_t key, std::string bytes);

  /// Entries neither found nor put stay as long as they take no more room than those that were; then what
  /// was used last leaves the folder first when its caches take more than 2 GB. Nothing is written if nothing
  /// was put. Throws Error{Output}.
  void save();

  const std::filesystem::path& file() const { return file_; }
  bool was_damaged() const { return damaged_; }
  size_t hits() const { return hits_; }
  size_t misses() const { return misses_; }

 private:
  struct Entry {
    std::string_view bytes;
    bool used = false;
  };

  std::filesystem::path file_;
  std::string content_;  // of the file that was read
  std::unordered_map<uint64_t, Entry> entries_;
  std::unordered_map<uint64_t, std::string> fresh_;
  std::vector<uint64_t> order_;  // of the entries in the file
  std::mutex mutex_;
  bool damaged_ = false;
  size_t hits_ = 0, misses_ = 0;
};

/// $XDG_CACHE_HOME/liana, or ~/.cache/liana; empty when neither variable is set.
std::filesystem::path default_cache_folder();

/// The cache of a plant: named after its path, so that baking it again finds it.
std::filesystem::path cache_file(const std::filesystem::path& folder, const std::filesystem::path& plant);

}  // namespace liana
