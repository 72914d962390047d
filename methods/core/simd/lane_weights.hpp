#pragma once

#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/stencil_table.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// The weights from a row on; null, which stands for ones, stays null.
inline const Pack* squares_of(const double* squared, long row) {
  return squared == nullptr ? nullptr : reinterpret_cast<const Pack*>(squared) + row;
}

/// Copies weights of a group's nodes; they become zero at the centre, which comes first, and in
/// padding. Returns `to`, or null where `from` is null: the weights are ones, which may stay in
/// padding, where monomials vanish.
inline const Pack* mask_weights(const StencilTable& table, int first, const Pack* from, Pack* to) {
  if (from == nullptr) return nullptr;
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
  for (int j = 1; j < least; ++j) to[j] = from[j];
  for (int j = least; j < table.size; ++j) {
    to[j] = choose(less(all(j), load(size)), from[j], all(0));
  }
  return to;
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
