#pragma once

#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/stencil_table.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// The weights from a row on; null, which stands for ones, stays null.
inline const Pack* squares_of(const double* squared, long row) {
  return squared == nullptr ? nullptr : reinterpret_cast<const Pack*>(squared) + row;
}

/// Copies weights of a group's nodes, ones where `from` is null; they become zero at the centre,
/// which comes first, and in padding.
inline void mask_weights(const StencilTable& table, int first, const Pack* from, Pack* to) {
  double size[lanes];
  int least = table.size;
  for (int lane = 0; lane < lanes; ++lane) {
    const int place = first + lane < table.count ? first + lane : table.count - 1;
    const std::int64_t* const offsets = table.offsets + table.chosen[place];
    const int count = static_cast<int>(offsets[1] - offsets[0]);
    size[lane] = count;
    least = count < least ? count : least;
  }
  to[0] = all(0);
  for (int j = 1; j < least; ++j) to[j] = from == nullptr ? all(1) : from[j];
  for (int j = least; j < table.size; ++j) {
    const Pack weight = from == nullptr ? all(1) : from[j];
    to[j] = choose(less(all(j), load(size)), weight, all(0));
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
