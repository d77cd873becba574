// Wall-clock time since construction.
#pragma once

#include <chrono>

namespace liana {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Seconds that work() takes.
template <class Work>
double timed(Work&& work) {
  const Stopwatch watch;
  work();
  return watch.seconds();
}

}  // namespace liana
