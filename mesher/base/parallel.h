// A loop over independent items on several threads, all of one pool.
#pragma once

#include <cstddef>

#include "mesher/base/function_ref.h"

namespace liana {

/// Number of threads to use when the user names none: one per core.
unsigned default_thread_count();

/// Starts what the program's one pool lacks for loops of `threads` (0: default_thread_count()). Threads that
/// exist are kept until the program ends, so a loop of no more threads starts none.
void start_threads(unsigned threads);

/// Calls body(i, worker) once for every i in [0, count), workers taking `grain` items at a time; worker is in
/// [0, threads), 0 the caller. The first exception thrown (lowest i) is rethrown after all workers stopped.
/// threads = 0 means default_thread_count(). Results must not depend on which worker takes which item, nor on
/// how many there are: a loop inside a loop gets those threads that are idle, perhaps none. Allocates
/// nothing.
void parallel_for(size_t count, unsigned threads, FunctionRef<void(size_t, unsigned)> body, size_t grain = 1);

}  // namespace liana
