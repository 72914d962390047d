#include "methods/core/large_array.hpp"

#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace strongpoint {
namespace {

/// Size of a huge page of most systems.
constexpr std::size_t huge_page = std::size_t{1} << 21;

/// Below this, ordinary memory is reused by the allocator more often than it is touched first.
constexpr std::size_t least_bytes = 2 * huge_page;

}  // namespace

void* allocate_large(std::size_t bytes) {
  if (bytes < least_bytes) {
    void* memory = std::malloc(bytes > 0 ? bytes : 1);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
  }
  const std::size_t whole = (bytes + huge_page - 1) / huge_page * huge_page;
  void* memory = std::aligned_alloc(huge_page, whole);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  // Advice alone: where the system declines, ordinary pages serve.
  static_cast<void>(madvise(memory, whole, MADV_HUGEPAGE));
#endif
  return memory;
}

void free_large(void* memory) noexcept { std::free(memory); }

}  // namespace strongpoint
