#pragma once

#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/stencil_table.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Copies weights of a group's nodes, zero at the centre, which comes first, and in padding.
inline void mask_weights(const StencilTable& table, int first, const Pack* from, Pack* to) {
  double size[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    const int place = first + lane < table.count ? first + lane : table.count - 1;
    const std::int64_t* const offsets = table.offsets + table.chosen[place];
    size[lane] = static_cast<double>(offsets[1] - offsets[0]);
  }
  const Pack sizes = load(size);
  to[0] = all(0);
  for (int j = 1; j < table.size; ++j) to[j] = choose(less(all(j), sizes), from[j], all(0));
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
