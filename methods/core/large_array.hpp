#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace strongpoint {

/// Memory of `bytes`, not cleared: of a megabyte or more it fills whole huge pages, where the
/// system has them, which take a tenth of the time to touch first. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);

/// Gives back what `allocate_large` gave.
void free_large(void* memory) noexcept;

/// Allocates arrays whose size is that of the cloud or larger. Elements that are given no value are
/// left uncleared: `resize` writes nothing.
template <class T>
struct LargeAllocator {
  using value_type = T;

  LargeAllocator() = default;
  template <class Other>
  LargeAllocator(const LargeAllocator<Other>&) noexcept {}

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_large(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) noexcept { free_large(memory); }
  template <class Element>
  void construct(Element* place) noexcept {
    ::new (static_cast<void*>(place)) Element;
  }
  template <class Element, class... Arguments>
  void construct(Element* place, Arguments&&... arguments) {
    std::construct_at(place, std::forward<Arguments>(arguments)...);
  }
  template <class Other>
  friend bool operator==(const LargeAllocator&, const LargeAllocator<Other>&) {
    return true;
  }
};

/// A vector for arrays of the size of a cloud or larger, whose new elements are not cleared.
template <class T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

}  // namespace strongpoint
