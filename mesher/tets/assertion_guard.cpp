#include "mesher/tets/assertion_guard.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include "mesher/base/error.h"
#include "mesher/tets/redirect_import.h"

namespace liana {
namespace {

thread_local std::jmp_buf* assertion_exit = nullptr;

[[noreturn]] void leave_assertion(const char* assertion, const char* file, unsigned line,
                                  const char* function) {
  if (assertion_exit) std::longjmp(*assertion_exit, 1);
  std::fprintf(stderr, "%s:%u: %s: Assertion `%s' failed.\n", file, line, function ? function : "",
               assertion);
  std::abort();
}

}  // namespace

bool survives_tetgen_assertions(const std::function<void()>& body) {
  static std::once_flag once;
  std::call_once(once, [] {
    require(redirect_import("libtet.so", "__assert_fail", reinterpret_cast<void*>(&leave_assertion)) > 0,
            "TetGen's assertions are out of reach: it is not linked as the shared library libtet.so");
  });
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
