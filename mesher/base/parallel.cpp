#include "mesher/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace liana {

namespace {

/// The program's threads. Each loop stands in a list until it has all helpers that it may have, or nothing is
/// left to do; idle threads help the newest one, which is the innermost. A caller works itself and waits for
/// nobody who has not begun, so loops inside loops cannot wait for each other.
class Pool {
 public:
  ~Pool() {
    {
      std::lock_guard lock(mutex_);
      ending_ = true;
    }
    start_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  void grow(size_t helpers) {
    if (helpers <= size_.load(std::memory_order_relaxed)) return;
    std::lock_guard lock(mutex_);
    while (threads_.size() < helpers) threads_.emplace_back([this] { serve(); });
    size_ = threads_.size();
  }

  // Runs work(0) here and work(1), work(2), … up to threads − 1 on as many threads as are idle.
  void run(unsigned threads, FunctionRef<void(unsigned)> work) {
    Loop loop{work, threads};
    {
      std::lock_guard lock(mutex_);
      loop.older = newest_;
      newest_ = &loop;
    }
    for (unsigned helper = 1; helper < threads; ++helper) start_.notify_one();
    work(0);
    std::unique_lock lock(mutex_);
    close(loop);
    done_.wait(lock, [&] { return loop.helpers == 0; });
  }

 private:
  struct Loop {  // on its caller's stack
    FunctionRef<void(unsigned)> work;
    unsigned threads;          // at most, with the caller
    unsigned next_worker = 1;  // number of the next helper
    unsigned helpers = 0;      // at work
    Loop* older = nullptr;
  };

  void serve() {
    std::unique_lock lock(mutex_);
    for (;;) {
      start_.wait(lock, [&] { return ending_ || newest_; });
      if (ending_) return;
      Loop& loop = *newest_;
      const unsigned worker = loop.next_worker++;
      ++loop.helpers;
      if (loop.next_worker == loop.threads) close(loop);
      lock.unlock();
      loop.work(worker);
      lock.lock();
      close(loop);  // nothing is left in it
      if (--loop.helpers == 0) done_.notify_all();
    }
  }

  void close(const Loop& loop) {
    for (Loop** at = &newest_; *at; at = &(*at)->older)
      if (*at == &loop) {
        *at = loop.older;
        return;
      }
  }

  std::mutex mutex_;
  std::condition_variable start_, done_;
  std::vector<std::thread> threads_;
  std::atomic<size_t> size_ = 0;
  Loop* newest_ = nullptr;
  bool ending_ = false;
};

Pool& pool() {
  static Pool pool;
  return pool;
}

}  // namespace

unsigned default_thread_count() {
  static const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return cores;
}

void start_threads(unsigned threads) {
  if (threads == 0) threads = default_thread_count();
  if (threads > 1) pool().grow(threads - 1);
}

void parallel_for(size_t count, unsigned threads, FunctionRef<void(size_t, unsigned)> body, size_t grain) {
  if (threads == 0) threads = default_thread_count();
  start_threads(threads);
  threads = static_cast<unsigned>(std::min<size_t>(threads, (count + grain - 1) / grain));

  std::atomic<size_t> next{0};
  std::mutex mutex;
  size_t first_failure = count;
  std::exception_ptr failure;

  const auto work = [&](unsigned worker) {
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
  if (threads < 2)
    work(0);
  else
    pool().run(threads, work);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace liana
