// Outputs are looked at before the work: a typo should cost no minutes.
#pragma once

#include <filesystem>

namespace liana {

/// Throws Error{Output} when `file` cannot come to be: its folder is missing or closed, or it is a folder
/// itself.
void require_writable_folder(const std::filesystem::path& file);

}  // namespace liana
