// The project's sources as the lints read them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace liana::lint {

/// The folder that holds README.md.
std::filesystem::path top();

/// All .h and .cpp under the folders, relative to the top, sorted.
std::vector<std::string> source_files(const std::vector<std::string>& folders = {
                                          "mesher", "modal", "materials", "runtime", "tests"});

std::vector<std::string> lines_of(const std::string& file);

/// What a shell command, run at the top, prints; fails the test if it does not end with 0.
std::string output_of(const std::string& command);

}  // namespace liana::lint
