// A typo in an output's name should cost no minutes.
#pragma once

#include <unistd.h>

#include <filesystem>

#include "mesher/base/error.h"

namespace liana {

/// Throws Error{Output} unless the file's folder exists and can be written to.
inline void require_writable_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder))
    throw Error(Error::Kind::Output, folder.string() + ": no such folder",
                "make it: mkdir -p " + folder.string());
  if (std::filesystem::is_directory(file))
    throw Error(Error::Kind::Output, file.string() + ": is a folder", "name a file in it");
  if (access(folder.c_str(), W_OK) != 0)
    throw Error(Error::Kind::Output, folder.string() + ": cannot be written to", "choose another place");
}

}  // namespace liana
