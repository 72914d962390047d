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

/// Copies numbers that are not read again soon, past the caches: a line that is not read before it
/// is written takes half the time.
inline void stream_copy(const double* from, long count, double* to) {
  constexpr long line = 8;
  const long past = static_cast<long>(reinterpret_cast<unsigned long>(to) / sizeof(double)) % line;
  long i = 0;
  for (const long head = past == 0 ? 0 : line - past; i < head && i < count; ++i) to[i] = from[i];
  for (; i + line <= count; i += line) {
#pragma GCC unroll 8
    for (long part = 0; part < line; part += lanes) stream(to + i + part, load(from + i + part));
  }
  for (; i < count; ++i) to[i] = from[i];
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
