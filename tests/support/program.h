// The program as a user runs it: arguments in, exit code and output out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace liana {

struct ProgramResult {
  int exit_code;    ///< 128 + signal when it was killed
  std::string out;  ///< stdout
  std::string err;  ///< stderr
};

/// Runs the built program in `folder`. Never throws for a program that fails: look at the exit code.
ProgramResult run_liana(const std::vector<std::string>& arguments, const std::filesystem::path& folder = ".");

}  // namespace liana
