#pragma once

#include <gtest/gtest.h>

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Runs a check on every path that the processor has.
template <class Check>
void on_every_path(const Check& check) {
  const SimdPath before = simd_path();
  for (SimdPath path : simd_paths()) {
    SCOPED_TRACE(name_of(path));
    use_simd_path(path);
    check();
  }
  use_simd_path(before);
}

}  // namespace strongpoint
