#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace strongpoint {

/// Memory that begins at a cache line, as kernels want it.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};

  CacheLineAllocator() = default;
  template <class U>
  explicit CacheLineAllocator(const CacheLineAllocator<U>&) {}
  template <class U>
  bool operator==(const CacheLineAllocator<U>&) const {
    return true;
  }
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), alignment));
  }
  void deallocate(T* place, std::size_t) { ::operator delete(place, alignment); }
};

/// Numbers for kernels.
using LaneArray = std::vector<double, CacheLineAllocator<double>>;

}  // namespace strongpoint
