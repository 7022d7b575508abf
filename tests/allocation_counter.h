// Counts allocations by operator new in the whole program, on every thread. It replaces the global operators, so
// include it in exactly one source of a test program:
//   const AllocationCounter counter;
//   ...
//   EXPECT_EQ(counter.count(), 0);
#pragma once
#include <atomic>
#include <cstdlib>
#include <new>

namespace aspic::test {

inline std::atomic<long> allocations = 0;

class AllocationCounter {
 public:
  long count() const { return allocations - at_start_; }  // since construction

 private:
  long at_start_ = allocations;
};

inline void* count_and_allocate(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded ? rounded : alignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace aspic::test

// NOLINTBEGIN(misc-definitions-in-headers): one source of a program includes this
// Not inlined: otherwise GCC warns that free() receives a pointer from operator new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return aspic::test::count_and_allocate(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
[[gnu::noinline]] void* operator new[](std::size_t size) { return operator new(size); }
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return aspic::test::count_and_allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new[](std::size_t size, std::align_val_t alignment) {
  return operator new(size, alignment);
}
// For std::stable_sort. A sanitizer's own version would not match the delete below.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++aspic::test::allocations;
  return std::malloc(size ? size : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
// NOLINTEND(misc-definitions-in-headers)
