// Runs TetGen, whose assertions would abort the process.
#pragma once

#include <functional>

namespace liana {

/// Calls `body`; returns false if an assert() of TetGen failed in it. The call is then left by longjmp:
/// destructors between the assertion and here do not run, so `body` must own nothing that matters. Exceptions
/// pass through. Only libtet.so's own calls of __assert_fail are led here: assertions of the caller's program
/// and of every other library abort as usual, and no symbol of glibc is replaced. Needs ELF, and TetGen as a
/// shared library.
bool survives_tetgen_assertions(const std::function<void()>& body);

}  // namespace liana
