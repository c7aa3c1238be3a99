// The program's large blocks ask for huge pages: handing out and looking up small ones takes half the time of loading a
// large mesh, and some of that of texturing. Where the kernel has none for it, they are as they were.
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined __linux__
#include <sys/mman.h>
#endif

namespace {

constexpr size_t kHugePage = size_t{1} << 21;

/// Of the pages that are all inside the block, so that it takes no more memory than it would.
void ask_for_huge_pages([[maybe_unused]] void* block, [[maybe_unused]] size_t bytes) {
#if defined MADV_HUGEPAGE
  const auto address = reinterpret_cast<uintptr_t>(block);
  const uintptr_t first = (address + kHugePage - 1) / kHugePage * kHugePage,
                  end = (address + bytes) / kHugePage * kHugePage;
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

}  // namespace

void* operator new(size_t bytes) {
  for (;;) {
    if (void* const block = std::malloc(bytes > 0 ? bytes : 1)) {
      if (bytes >= kHugePage) ask_for_huge_pages(block, bytes);
      return block;
    }
    if (const std::new_handler free_some = std::get_new_handler())
      free_some();
    else
      throw std::bad_alloc();
  }
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, size_t) noexcept { std::free(block); }
