#include "base/huge_pages.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace aspic {

void* allocate_huge_pages(size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr size_t kPage = size_t{2} << 20;
#else
  constexpr size_t kPage = 64;
#endif
  const size_t pages = (bytes + kPage - 1) / kPage;
  void* memory = std::aligned_alloc(kPage, pages * kPage);
  if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  madvise(memory, pages * kPage, MADV_HUGEPAGE);  // a hint: without huge pages all works, only slower
#endif
  return memory;
}

}  // namespace aspic
