#include "mesher/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace liana {

namespace {

// Threads that wait for the next loop: starting one costs as much as stepping a small plant, and what it
// keeps in thread_local memory would be made anew.
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

  // Runs work(0) here and work(1 … threads − 1) elsewhere, and waits for all. One caller at a time.
  void run(unsigned threads, const std::function<void(unsigned)>& work) {
    {
      std::lock_guard lock(mutex_);
      while (threads_.size() + 1 < threads) {
        const auto worker = static_cast<unsigned>(threads_.size() + 1);
        threads_.emplace_back([this, worker, seen = round_] { serve(worker, seen); });
      }
      work_ = &work;
      wanted_ = threads;
      running_ = threads - 1;
      ++round_;
    }
    start_.notify_all();
    work(0);
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&] { return running_ == 0; });
  }

 private:
  void serve(unsigned worker, uint64_t seen) {
    std::unique_lock lock(mutex_);
    for (;;) {
      start_.wait(lock, [&] { return ending_ || round_ != seen; });
      if (ending_) return;
      seen = round_;
      if (worker >= wanted_) continue;
      const std::function<void(unsigned)>& work = *work_;
      lock.unlock();
      work(worker);
      lock.lock();
      if (--running_ == 0) done_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable start_, done_;
  std::vector<std::thread> threads_;
  const std::function<void(unsigned)>* work_ = nullptr;
  unsigned wanted_ = 0, running_ = 0;
  uint64_t round_ = 0;
  bool ending_ = false;
};

std::atomic_flag pool_in_use;
Pool& pool() {
  static Pool pool;
  return pool;
}

}  // namespace

unsigned default_thread_count() {
  return std::max(1u, std::thread::hardware_concurrency());
}

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

  // The threads that wait are used unless another loop, perhaps the one that called this, has them.
  if (threads < 2) {
    work(0);
  } else if (!pool_in_use.test_and_set(std::memory_order_acquire)) {
    pool().run(threads, work);
    pool_in_use.clear(std::memory_order_release);
  } else {
    std::vector<std::thread> others;
    for (unsigned worker = 1; worker < threads; ++worker) others.emplace_back(work, worker);
    work(0);
    for (std::thread& thread : others) thread.join();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace liana
