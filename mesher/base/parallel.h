// A loop over independent items on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace liana {

/// Number of threads to use when the user names none: one per core.
unsigned default_thread_count();

/// Calls body(i, worker) once for every i in [0, count), workers taking `grain` items at a time; worker is in
/// [0, threads). The first exception thrown (lowest i) is rethrown after all workers stopped.
/// threads = 0 means default_thread_count(). Results must not depend on which worker takes which item.
void parallel_for(size_t count, unsigned threads, const std::function<void(size_t, unsigned)>& body,
                  size_t grain = 1);

}  // namespace liana
