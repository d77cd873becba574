// Runs a third-party function whose assertions would abort the process.
#pragma once

#include <functional>

namespace liana {

/// Calls `body`; returns false if an assert() inside it failed. The call is then left by longjmp: destructors
/// between the assertion and here do not run, so `body` must own nothing that matters. Exceptions pass
/// through. Assertions anywhere else in the process, and on other threads, abort as usual. Works with shared
/// libraries of glibc.
bool survives_assertions(const std::function<void()>& body);

}  // namespace liana
