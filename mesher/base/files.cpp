#include "mesher/base/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "mesher/base/error.h"

namespace liana {
namespace fs = std::filesystem;

std::string read_file(const fs::path& path, size_t max_bytes) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status))
    throw Error(Error::Kind::Input, path.string() + ": no such file",
                "check the path; it is relative to the current folder");
  if (fs::is_directory(status)) throw Error(Error::Kind::Input, path.string() + ": is a folder, not a file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(Error::Kind::Input, path.string() + ": " + std::strerror(errno));
  in.seekg(0, std::ios::end);
  const auto size = static_cast<size_t>(in.tellg());
  if (size > max_bytes)
    throw Error(Error::Kind::Input,
                path.string() + ": larger than the limit of " + std::to_string(max_bytes) + " bytes");
  std::string bytes(size, '\0');
  in.seekg(0);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in) throw Error(Error::Kind::Input, path.string() + ": could not be read to its end");
  return bytes;
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
  std::error_code code;
  if (fs::is_symlink(path_, code)) path_ = fs::weakly_canonical(path_);  // the link stays
  if (const fs::file_status status = fs::status(path_, code);
      fs::exists(status) && !fs::is_regular_file(status))
    throw Error(Error::Kind::Output, path_.string() + ": is no regular file", "name another output");
  partial_ = path_;
  partial_.replace_filename(path_.stem().string() + "." + std::to_string(getpid()) + ".partial" +
                            path_.extension().string());
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  fs::remove(partial_, ignored);
}

void AtomicFile::commit() {
  const int file = open(partial_.c_str(), O_RDONLY);
  const bool flushed = file >= 0 && fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) close(file);
  if (!flushed) throw Error(Error::Kind::Output, path_.string() + ": " + std::strerror(reason));
  std::error_code code;
  fs::rename(partial_, path_, code);
  if (code) throw Error(Error::Kind::Output, path_.string() + ": " + code.message());
}

void write_file(const fs::path& path, std::string_view bytes) {
  const auto write = [&](const fs::path& to) {
    std::ofstream out(to, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out)
      throw Error(Error::Kind::Output, path.string() + ": cannot be written (" + std::strerror(errno) + ")",
                  "check that the folder exists, is writable and has space");
  };
  const std::string name = path.string();
  if (name.starts_with("/dev/") || name.starts_with("/proc/"))
    return write(path);  // never replaced by a file
  AtomicFile file(path);
  write(file.partial());
  file.commit();
}

}  // namespace liana
