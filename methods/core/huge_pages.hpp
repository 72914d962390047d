#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace strongpoint {

/// Resizes a table that is about to be filled for the first time, and asks the system for huge
/// pages beneath it where it is large: that many small ones cost more than to fill the table.
template <class T>
void resize_large(std::vector<T>& table, std::size_t size) {
  table.reserve(size);
#if defined(__linux__)
  constexpr std::uintptr_t page = 1U << 21U;
  const auto begin = (reinterpret_cast<std::uintptr_t>(table.data()) + page - 1) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(table.data() + size) / page * page;
  // A hint: where the system does not follow it, nothing is lost.
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
  table.resize(size);
}

}  // namespace strongpoint
