// Threads that wait between steps, for work too short to start threads for.
#pragma once

#include <barrier>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace liana {

/// run() calls the body once on every worker, worker 0 being the caller. Inside, wait() lets none go on
/// before all have come. Allocates nothing after its making. The body must not throw.
class WorkerTeam {
 public:
  /// 0: one per core.
  explicit WorkerTeam(unsigned threads);
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;
  ~WorkerTeam();

  unsigned size() const { return size_; }
  void run(const std::function<void(unsigned worker)>& body);
  void wait() {
    if (size_ > 1) barrier_.arrive_and_wait();
  }

 private:
  void work(unsigned worker);

  unsigned size_;
  std::barrier<> barrier_;
  std::mutex mutex_;
  std::condition_variable started_;
  const std::function<void(unsigned)>* body_ = nullptr;
  uint64_t round_ = 0;
  bool ending_ = false;
  std::vector<std::thread> others_;
};

}  // namespace liana
