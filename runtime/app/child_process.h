// This program again, as a child that may fail, run out of memory or be killed alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesher/base/progress.h"

namespace liana {

/// Runs this program and waits; what it prints goes to `log`. When progress says so, the child is interrupted
/// as by Ctrl-C, waited for, and Error{Cancelled} is thrown. Returns its exit code, or 128 + signal. Safe on
/// several threads. Throws Error{Output} when the log cannot be written or no process can be started.
int run_self(const std::vector<std::string>& arguments, const std::filesystem::path& log,
             const Progress& progress);

}  // namespace liana
