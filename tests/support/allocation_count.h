// How often this program has asked for memory or for a thread. Counts nothing under a sanitizer, which has
// its own memory functions.
#pragma once

#include <cstddef>

namespace liana::test {

size_t allocation_count();  ///< malloc, calloc, realloc, aligned_alloc, posix_memalign, and all that use them
size_t thread_count();      ///< pthread_create

}  // namespace liana::test
