#include "base/platform.h"

#if defined(__wasm__)
#include <cstdlib>
#else
#include <sys/mman.h>
#endif

namespace hedon {

#if defined(__wasm__)

void* reserve_pages(size_t bytes) { return calloc(bytes, 1); }

void release_pages(void* block, size_t) { free(block); }

#else

void* reserve_pages(size_t bytes) {
  void* block = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (block == MAP_FAILED) return nullptr;
#if defined(MADV_HUGEPAGE)
  madvise(block, bytes, MADV_HUGEPAGE);  // a hint: without it, everything works, but slower
#endif
  return block;
}

void release_pages(void* block, size_t bytes) { munmap(block, bytes); }

#endif

}  // namespace hedon
