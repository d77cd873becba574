// Working memory of many megabytes in few pages, where the system has larger ones.
#pragma once

#include <cstddef>
#include <memory>

namespace liana::lanes {

/// Uninitialised numbers; growing forgets them.
class LargeNumbers {
 public:
  /// Throws std::bad_alloc.
  void grow(size_t count);
  double* data() const { return numbers_.get(); }

 private:
  struct Free {
    void operator()(double* numbers) const;
  };
  std::unique_ptr<double, Free> numbers_;
  size_t count_ = 0;
};

}  // namespace liana::lanes
