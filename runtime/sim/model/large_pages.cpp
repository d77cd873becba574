#include "runtime/sim/model/large_pages.h"

#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace liana {

void* allocate_large_pages(size_t bytes) {
  constexpr size_t kLine = 64, kLargePage = size_t{1} << 21;
  const size_t unit = bytes < kLargePage ? kLine : kLargePage, whole = (bytes + unit - 1) / unit * unit;
  void* memory = whole < bytes ? nullptr : std::aligned_alloc(unit, whole);
  if (!memory) throw std::bad_alloc();
#ifdef __linux__
  if (unit == kLargePage) madvise(memory, whole, MADV_HUGEPAGE);  // a wish: without it, only slower
#endif
  return memory;
}

void free_large_pages(void* memory) noexcept {
  std::free(memory);
}

}  // namespace liana
