#include "runtime/app/writable.h"

#include <unistd.h>

#include "mesher/base/error.h"

namespace liana {
namespace fs = std::filesystem;

void require_writable_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    throw Error(Error::Kind::Output, folder.string() + ": no such folder",
                "make it: mkdir -p " + folder.string());
  if (fs::is_directory(file))
    throw Error(Error::Kind::Output, file.string() + ": is a folder", "name a file in it");
  if (access(folder.c_str(), W_OK) != 0)
    throw Error(Error::Kind::Output, folder.string() + ": cannot be written to", "choose another folder");
}

}  // namespace liana
