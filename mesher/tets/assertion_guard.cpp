#include "mesher/tets/assertion_guard.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>

namespace {
thread_local std::jmp_buf* assertion_exit = nullptr;
}

// Takes the place of glibc's for the whole program: the executable's symbols come before those of shared
// libraries.
extern "C" [[noreturn]] void __assert_fail(const char* assertion, const char* file, unsigned line,
                                           const char* function) noexcept {
  if (assertion_exit) std::longjmp(*assertion_exit, 1);
  std::fprintf(stderr, "%s:%u: %s: Assertion `%s' failed.\n", file, line, function ? function : "",
               assertion);
  std::abort();
}

namespace liana {

bool survives_assertions(const std::function<void()>& body) {
  std::jmp_buf here;
  if (setjmp(here) != 0) {
    assertion_exit = nullptr;
    return false;
  }
  assertion_exit = &here;
  try {
    body();
  } catch (...) {
    assertion_exit = nullptr;
    throw;
  }
  assertion_exit = nullptr;
  return true;
}

}  // namespace liana
