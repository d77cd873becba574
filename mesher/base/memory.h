// Asking for memory before it is taken.
#pragma once

#include <cstddef>
#include <string>

namespace liana {

size_t available_memory();  ///< bytes the machine can still give; the largest size_t where that is unknown

/// Throws Error{Input} starting with `what` when `bytes` are more than is available, saying both and what to
/// do.
void require_memory(size_t bytes, const std::string& what);

}  // namespace liana
