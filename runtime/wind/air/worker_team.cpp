#include "runtime/wind/air/worker_team.h"

#include "mesher/base/parallel.h"

namespace liana {

WorkerTeam::WorkerTeam(unsigned threads)
    : size_(threads == 0 ? default_thread_count() : threads), barrier_(size_) {
  for (unsigned worker = 1; worker < size_; ++worker) others_.emplace_back([this, worker] { work(worker); });
}

WorkerTeam::~WorkerTeam() {
  {
    std::lock_guard lock(mutex_);
    ending_ = true;
  }
  started_.notify_all();
  for (std::thread& other : others_) other.join();
}

void WorkerTeam::run(const std::function<void(unsigned)>& body) {
  if (size_ > 1) {
    std::lock_guard lock(mutex_);
    body_ = &body;
    ++round_;
  }
  started_.notify_all();
  body(0);
  wait();  // the others are done, too
}

void WorkerTeam::work(unsigned worker) {
  for (uint64_t done = 0;;) {
    const std::function<void(unsigned)>* body;
    {
      std::unique_lock lock(mutex_);
      started_.wait(lock, [&] { return ending_ || round_ != done; });
      if (ending_) return;
      done = round_;
      body = body_;
    }
    (*body)(worker);
    wait();
  }
}

}  // namespace liana
