#include "mesher/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace liana {

unsigned default_thread_count() { return std::max(1u, std::thread::hardware_concurrency()); }

void parallel_for(size_t count, unsigned threads, const std::function<void(size_t, unsigned)>& body,
                  size_t grain) {
  if (threads == 0) threads = default_thread_count();
  threads = static_cast<unsigned>(std::min<size_t>(threads, (count + grain - 1) / grain));

  std::atomic<size_t> next{0};
  std::mutex mutex;
  size_t first_failure = count;
  std::exception_ptr failure;

  auto work = [&](unsigned worker) {
    for (size_t begin; (begin = next.fetch_add(grain)) < count;) {
      for (size_t i = begin; i < std::min(count, begin + grain); ++i) {
        try {
          body(i, worker);
        } catch (...) {
          std::lock_guard lock(mutex);
          if (i < first_failure) first_failure = i, failure = std::current_exception();
          next = count;
          return;
        }
      }
    }
  };

  std::vector<std::thread> others;
  for (unsigned worker = 1; worker < threads; ++worker) others.emplace_back(work, worker);
  work(0);
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace liana
