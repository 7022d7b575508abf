// Vectors whose memory is in huge pages, where the system offers them on request (Linux). Large arrays that are read in
// every iteration then need few entries of the processor's cache of page addresses (TLB).
#pragma once
#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace aspic {

void* allocate_huge_pages(size_t bytes);  // throws std::bad_alloc; to be freed by std::free

// An allocator for std::vector. Small arrays are allocated as usual. New elements without a value are uninitialized, so
// that the threads that write them first also wait for their pages.
template <class T>
struct HugePages {
  using value_type = T;
  static constexpr size_t kLarge = (size_t{2} << 20) / sizeof(T);  // elements in a huge page

  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>&) {}

  T* allocate(size_t count) {
    if (count >= kLarge) return static_cast<T*>(allocate_huge_pages(count * sizeof(T)));
    return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(alignof(T))));
  }
  void deallocate(T* memory, size_t count) {
    if (count >= kLarge)
      std::free(memory);
    else
      ::operator delete(memory, std::align_val_t(alignof(T)));
  }
  template <class U, class... Arguments>
  void construct(U* element, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0)
      ::new (static_cast<void*>(element)) U;
    else
      ::new (static_cast<void*>(element)) U(std::forward<Arguments>(arguments)...);
  }
  bool operator==(const HugePages&) const { return true; }
};

template <class T>
using LargeVector = std::vector<T, HugePages<T>>;

}  // namespace aspic
