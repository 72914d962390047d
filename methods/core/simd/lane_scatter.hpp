#pragma once

#include <cstdint>

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Writes rows r to r + lanes - 1 as `scatter_lanes` does, of all lanes.
inline void scatter_block(const Pack* rows, int r, double* const* to) {
  Pack turned[lanes];
  transpose(rows + r, turned);
#pragma GCC unroll 8
  for (int lane = 0; lane < lanes; ++lane) store(to[lane] + r, turned[lane]);
}

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
    if (bits == every_lane) {
      scatter_block(rows, r, to);
      continue;
    }
    Pack turned[lanes];
    transpose(rows + r, turned);
    for (int lane = 0; lane < lanes; ++lane) {
      if ((bits >> lane & 1U) != 0) store(to[lane] + r, turned[lane]);
    }
  }
}

/// Numbers from a place to the end of its page.
inline int left_in_page(const double* place) {
  constexpr std::uintptr_t page = 4096;
  return static_cast<int>((page - reinterpret_cast<std::uintptr_t>(place) % page) / sizeof(double));
}

/// The first of the blocks of `lanes` rows, from row `begin` on, that some lane would store across
/// two pages; `end` if none.
inline int first_across_pages(double* const* to, int begin, int end) {
  int first = end;
#pragma GCC unroll 8
  for (int lane = 0; lane < lanes; ++lane) {
    const int left = left_in_page(to[lane] + begin);
    const int block = begin + left / lanes * lanes;
    // A page holds whole blocks.
    if (left % lanes != 0 && block < first) first = block;
  }
  return first;
}

/// Writes rows r to r + lanes - 1, in two parts where a pack would lie across two pages.
inline void scatter_block_by_page(const Pack* rows, int r, double* const* to) {
  Pack turned[lanes];
  transpose(rows + r, turned);
#pragma GCC unroll 8
  for (int lane = 0; lane < lanes; ++lane) {
    double* const part = to[lane] + r;
    const int left = left_in_page(part);
    if (left >= lanes) {
      store(part, turned[lane]);
      continue;
    }
    double buffer[lanes];
    store(buffer, turned[lane]);
    for (int i = 0; i < left; ++i) part[i] = buffer[i];
    for (int i = left; i < lanes; ++i) part[i] = buffer[i];
  }
}

/// The same as `scatter_lanes` of all lanes for what is read again soon: on some processors a store
/// across two pages then takes the time of a hundred others.
inline void scatter_by_page(const Pack* rows, int count, double* const* to) {
  if (count < lanes) return scatter_lanes(rows, count, to, every_lane);
  const int whole = count - count % lanes;
  for (int r = 0; r < whole; r += lanes) {
    const int across = first_across_pages(to, r, whole);
    for (; r < across; r += lanes) scatter_block(rows, r, to);
    if (r < whole) scatter_block_by_page(rows, r, to);
  }
  if (whole < count) scatter_block_by_page(rows, count - lanes, to);
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
