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

/// Runs a program by its path, or its name on $PATH, in `folder`. Never throws for a program that fails.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder = ".");

/// Where a program of this name is on $PATH; empty when it is nowhere.
std::filesystem::path find_program(const std::string& name);

/// Runs the built program in `folder`. Never throws for a program that fails: look at the exit code.
ProgramResult run_liana(const std::vector<std::string>& arguments, const std::filesystem::path& folder = ".");

}  // namespace liana
