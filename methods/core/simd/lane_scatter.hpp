#pragma once

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Writes lane l of rows[0], rows[1], ... to to[l][0], to[l][1], ..., `count` of them, for the
/// lanes whose bits are set.
inline void scatter_lanes(const Pack* rows, int count, double* const* to, unsigned bits) {
  if (count < lanes) {
    double buffer[lanes];
    for (int r = 0; r < count; ++r) {
      store(buffer, rows[r]);
      for (int lane = 0; lane < lanes; ++lane) {
        if ((bits >> lane & 1U) != 0) to[lane][r] = buffer[lane];
      }
    }
    return;
  }
  for (int begin = 0; begin < count; begin += lanes) {
    const int r = begin + lanes <= count ? begin : count - lanes;  // the last ones overlap
    Pack turned[lanes];
    transpose(rows + r, turned);
    if (bits == every_lane) {
#pragma GCC unroll 8
      for (int lane = 0; lane < lanes; ++lane) store(to[lane] + r, turned[lane]);
      continue;
    }
    for (int lane = 0; lane < lanes; ++lane) {
      if ((bits >> lane & 1U) != 0) store(to[lane] + r, turned[lane]);
    }
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
