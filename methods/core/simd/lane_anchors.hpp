#pragma once

#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/stencil_table.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// The anchors of a group, one a lane.
struct LaneAnchors {
  int of[lanes];   ///< the last one repeated where the group is not full
  bool in_a_row;   ///< each follows the one before, and all stencils have the table's size
  const int* ids;  ///< the first stencil; the others follow. Null unless in a row
};

/// Anchors `first` and following of a table; `lanes` of them or what is left.
inline LaneAnchors anchors_of(const StencilTable& table, int first) {
  LaneAnchors anchors;
  anchors.in_a_row = false;
  anchors.ids = nullptr;
  if (first + lanes > table.count) {
    for (int lane = 0; lane < lanes; ++lane) {
      anchors.of[lane] = table.chosen[first + lane < table.count ? first + lane : table.count - 1];
    }
    return anchors;
  }
  const int* const chosen = table.chosen + first;
  int strays = 0;
#pragma GCC unroll 8
  for (int lane = 0; lane < lanes; ++lane) {
    anchors.of[lane] = chosen[lane];
    strays |= chosen[lane] - chosen[0] - lane;
  }
  if (strays != 0) return anchors;
  // No stencil is larger than the table's size.
  const std::int64_t* const offsets = table.offsets + chosen[0];
  anchors.in_a_row = offsets[lanes] - offsets[0] == static_cast<std::int64_t>(lanes) * table.size;
  if (anchors.in_a_row) anchors.ids = table.ids + offsets[0];
  return anchors;
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
