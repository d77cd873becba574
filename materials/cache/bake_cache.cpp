#include "materials/cache/bake_cache.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "materials/bake/byte_stream.h"
#include "materials/cache/program_identity.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "LIANACH\n";
constexpr uint32_t kVersion = 1;
constexpr size_t kHeader = kMagic.size() + 2 * sizeof(uint32_t) + 3 * sizeof(uint64_t);
constexpr uintmax_t kFolderBytes = uintmax_t{2} << 30;
constexpr const char* kExtension = ".cache";

/// Removes the files used longest ago until the rest fits. Others may do the same at the same time.
void bound_folder(const fs::path& folder, const fs::path& keep) {
  struct Old {
    fs::file_time_type used;
    fs::path path;
    uintmax_t size;
  };
  std::vector<Old> files;
  uintmax_t total = 0;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    if (entry.path().extension() != kExtension) continue;
    std::error_code gone;
    const Old file{entry.last_write_time(gone), entry.path(), entry.file_size(gone)};
    if (!gone) files.push_back(file), total += file.size;
  }
  std::sort(files.begin(), files.end(), [](const Old& a, const Old& b) { return a.used < b.used; });
  for (const Old& file : files) {
    if (total <= kFolderBytes) break;
    if (file.path == keep) continue;
    fs::remove(file.path, code);
    total -= file.size;
  }
}

}  // namespace

BakeCache::BakeCache(fs::path file) : file_(std::move(file)) {
  if (!fs::exists(file_)) return;
  try {
    content_ = read_file(file_, kFolderBytes);
    ByteReader reader(content_, file_.string());
    for (const char c : kMagic)
      if (reader.number<char>() != c) reader.fail("is no cache");
    if (reader.number<uint32_t>() != kVersion) return;
    const auto count = reader.number<uint32_t>();
    const auto program = reader.number<uint64_t>(), size = reader.number<uint64_t>(),
               checksum = reader.number<uint64_t>();
    if (program != program_identity()) return;
    if (size != reader.left() || hash_bytes(content_.data() + kHeader, size) != checksum)
      reader.fail("is damaged");
    for (uint32_t i = 0; i < count; ++i) {
      const auto key = reader.number<uint64_t>();
      const auto bytes = reader.number<uint32_t>();
      const size_t at = content_.size() - reader.left();
      reader.skip(bytes);
      entries_[key] = {std::string_view(content_).substr(at, bytes)};
      order_.push_back(key);
    }
  } catch (const Error&) {
    damaged_ = true;
    entries_.clear(), order_.clear();
  }
}

std::optional<std::string_view> BakeCache::find(uint64_t key) {
  std::lock_guard lock(mutex_);
  if (const auto fresh = fresh_.find(key); fresh != fresh_.end()) return ++hits_, fresh->second;
  const auto found = entries_.find(key);
  if (found == entries_.end()) return ++misses_, std::nullopt;
  found->second.used = true;
  return ++hits_, found->second.bytes;
}

void BakeCache::put(uint64_t key, std::string bytes) {
  std::lock_guard lock(mutex_);
  fresh_.emplace(key, std::move(bytes));
}

void BakeCache::save() {
  if (fresh_.empty()) {
    std::error_code ignored;  // to be counted as used now
    fs::last_write_time(file_, fs::file_time_type::clock::now(), ignored);
    return;
  }
  ByteWriter payload;
  uint32_t count = 0;
  const auto write = [&](uint64_t key, std::string_view bytes) {
    payload.number(key);
    payload.text(bytes);
    ++count;
  };
  for (const auto& [key, bytes] : fresh_) write(key, bytes);
  for (const uint64_t key : order_)
    if (entries_[key].used && !fresh_.contains(key)) write(key, entries_[key].bytes);
  const size_t room = 2 * payload.bytes().size();
  for (const uint64_t key : order_)
    if (!entries_[key].used && !fresh_.contains(key) &&
        payload.bytes().size() + entries_[key].bytes.size() < room)
      write(key, entries_[key].bytes);

  ByteWriter file;
  for (const char c : kMagic) file.number(c);
  file.number(kVersion), file.number(count), file.number(program_identity());
  file.number(uint64_t{payload.bytes().size()});
  file.number(hash_bytes(payload.bytes().data(), payload.bytes().size()));
  std::error_code code;
  fs::create_directories(file_.parent_path(), code);
  write_file(file_, file.bytes() + payload.bytes());
  bound_folder(file_.parent_path(), file_);
}

fs::path default_cache_folder() {
  const auto variable = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);
    return value && fs::path(value).is_absolute() ? fs::path(value) : fs::path();
  };
  if (const fs::path given = variable("XDG_CACHE_HOME"); !given.empty()) return given / "liana";
  if (const fs::path home = variable("HOME"); !home.empty()) return home / ".cache" / "liana";
  return {};
}

fs::path cache_file(const fs::path& folder, const fs::path& plant) {
  const std::string path = fs::absolute(plant).lexically_normal().string();
  return folder /
         (plant.stem().string() + "-" + hash_text(hash_bytes(path.data(), path.size())) + kExtension);
}

}  // namespace liana
