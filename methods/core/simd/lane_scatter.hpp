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

/// Copies numbers of eight bytes that are not read again soon, past the caches.
template <class Number>
void stream_copy(const Number* from, long count, Number* to) {
  static_assert(sizeof(Number) == sizeof(double), "they are copied as packs of doubles");
  constexpr long line = 8;
  const auto past = static_cast<long>(reinterpret_cast<unsigned long>(to) / sizeof(Number)) % line;
  long i = 0;
  if constexpr (lanes > 1) {
    for (const long head = past == 0 ? 0 : line - past; i < head && i < count; ++i) to[i] = from[i];
    for (; i + line <= count; i += line) {
#pragma GCC unroll 8
      for (long part = 0; part < line; part += lanes) {
        stream(reinterpret_cast<double*>(to + i + part),
               load(reinterpret_cast<const double*>(from + i + part)));
      }
    }
  }
  for (; i < count; ++i) to[i] = from[i];
}

/// True when the lanes' results, of `count` numbers each, lie one after the other; `entries` are
/// 0 in lanes without any.
inline bool is_one_piece(int count, const int* entries, double* const* to) {
  bool follows = true;
  for (int lane = 0; lane < lanes; ++lane) {
    follows =
        follows && entries[lane] == count && to[lane] == to[0] + static_cast<long>(lane) * count;
  }
  return follows;
}

/// A piece of results that waits to be written past the caches: right after its making, its parts
/// have not reached the first-level cache, and reading them would stall.
struct Piece {
  const double* from = nullptr;
  double* to = nullptr;
  long count = 0;

  void write() {
    stream_copy(from, count, to);
    count = 0;
  }
};

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
