#include "runtime/sim/lanes/large_numbers.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace liana::lanes {

void LargeNumbers::Free::operator()(double* numbers) const {
  std::free(numbers);
}

void LargeNumbers::grow(size_t count) {
  if (count <= count_) return;
  constexpr size_t kLine = 64, kLargePage = size_t{1} << 21;
  count = std::max(count, count_ + count_ / 2);  // plants grow a little at a time
  const size_t bytes = count * sizeof(double), unit = bytes < kLargePage ? kLine : kLargePage;
  const size_t whole = (bytes + unit - 1) / unit * unit;
  numbers_.reset();
  count_ = 0;
  numbers_.reset(static_cast<double*>(std::aligned_alloc(unit, whole)));
  if (!numbers_) throw std::bad_alloc();
  count_ = count;
#ifdef __linux__
  if (unit == kLargePage) madvise(numbers_.get(), whole, MADV_HUGEPAGE);  // a wish: without it, only slower
#endif
}

}  // namespace liana::lanes
