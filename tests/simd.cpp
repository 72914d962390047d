// Paths of kernels: which there are, and how one is chosen.
#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "methods/core/simd/path.hpp"

namespace strongpoint {
namespace {

TEST(SimdPath, TheScalarOneIsAlwaysThere) {
  EXPECT_EQ(simd_paths().front(), SimdPath::scalar);
  EXPECT_EQ(name_of(SimdPath::scalar), "scalar");
}

TEST(SimdPath, EveryPathThatTheProcessorHasCanBeUsed) {
  const SimdPath before = simd_path();
  for (SimdPath path : simd_paths()) {
    use_simd_path(path);
    EXPECT_EQ(simd_path(), path);
  }
  use_simd_path(before);
}

TEST(SimdPath, OneThatIsNotToBeHadIsRefusedByName) {
  for (SimdPath path : {SimdPath::avx2, SimdPath::avx512}) {
    bool is_there = false;
    for (SimdPath there : simd_paths()) is_there = is_there || there == path;
    if (is_there) continue;
    EXPECT_THROW(use_simd_path(path), UsageError) << name_of(path);
  }
}

}  // namespace
}  // namespace strongpoint
