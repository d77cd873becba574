// Memory for arrays of many megabytes in few pages, where the system has larger ones: half a kilobyte of page
// table to walk per particle costs a tenth of a step.
#pragma once

#include <cstddef>
#include <type_traits>

namespace liana {

/// Uninitialised, on a line of the cache; from 2 MiB on in large pages. Throws std::bad_alloc.
void* allocate_large_pages(size_t bytes);
void free_large_pages(void* memory) noexcept;

/// An allocator for the standard containers.
template <class T>
struct LargePages {
  using value_type = T;
  using size_type = size_t;
  using difference_type = std::ptrdiff_t;
  using propagate_on_container_move_assignment = std::true_type;
  using is_always_equal = std::true_type;

  LargePages() = default;
  template <class Other>
  LargePages(const LargePages<Other>&) {}
  T* allocate(size_t count) {
    static_assert(alignof(T) <= 64);
    return static_cast<T*>(allocate_large_pages(count * sizeof(T)));
  }
  void deallocate(T* memory, size_t) noexcept { free_large_pages(memory); }
  friend bool operator==(const LargePages&, const LargePages&) { return true; }
};

}  // namespace liana
