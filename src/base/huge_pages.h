// Vectors whose memory is in huge pages, where the system offers them on request (Linux). Large arrays that are read in
// every iteration then need few entries of the processor's cache of page addresses (TLB).
#pragma once
#ifdef __linux__
#include <sys/mman.h>
#endif

#include <cstdlib>
#include <new>
#include <vector>

namespace aspic {

// An allocator for std::vector. Small arrays are allocated as usual.
template <class T>
struct HugePages {
  using value_type = T;
  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>&) {}

  T* allocate(size_t count) {
    if (!is_large(count)) return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(alignof(T))));
    const size_t bytes = (count * sizeof(T) + kPage - 1) / kPage * kPage;
    void* memory = std::aligned_alloc(kPage, bytes);
    if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    madvise(memory, bytes, MADV_HUGEPAGE);  // a hint; without it all works, only slower
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t count) {
    if (is_large(count))
      std::free(memory);
    else
      ::operator delete(memory, std::align_val_t(alignof(T)));
  }
  bool operator==(const HugePages&) const { return true; }

 private:
  static constexpr size_t kPage = size_t{2} << 20;
  static bool is_large(size_t count) {
#ifdef MADV_HUGEPAGE
    return count >= kPage / sizeof(T);
#else
    return false;
#endif
  }
};

template <class T>
using LargeVector = std::vector<T, HugePages<T>>;

}  // namespace aspic
