#include "methods/core/kept_memory.hpp"

#include <cstdint>

#include <gtest/gtest.h>

#include "methods/core/large_array.hpp"
#include "methods/core/sanitizers.hpp"

namespace strongpoint {
namespace {

constexpr std::size_t bytes = std::size_t{1} << 24;

TEST(KeptMemory, IsTakenAgainByArraysOfTheSameSize) {
  if (checks_addresses) GTEST_SKIP() << "nothing is kept where every access is checked";
  release_kept_memory();
  void* const first = allocate_large(bytes);
  free_large(first);
  void* const again = allocate_large(bytes);
  EXPECT_EQ(first, again);
  void* const other = allocate_large(bytes);
  EXPECT_NE(again, other);
  free_large(again);
  free_large(other);
  release_kept_memory();
}

TEST(KeptMemory, BeginsWithArraysOfAMegabyte) {
  constexpr std::uintptr_t huge_page = std::uintptr_t{1} << 21;
  void* const memory = allocate_large(std::size_t{1} << 20);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % huge_page, 0U);
  free_large(memory);
}

TEST(KeptMemory, HoldsWhatIsWrittenWhateverTheSizes) {
  LargeArray<std::int64_t> numbers;
  for (std::int64_t i = 0; i < 5000000; ++i) numbers.push_back(i);  // grows through many blocks
  const LargeArray<std::int64_t> copy = numbers;
  numbers.clear();
  numbers.shrink_to_fit();
  release_kept_memory();
  std::int64_t others = 0;
  for (std::size_t i = 0; i < copy.size(); ++i)
    others += copy[i] == static_cast<std::int64_t>(i) ? 0 : 1;
  EXPECT_EQ(others, 0);
}

}  // namespace
}  // namespace strongpoint
