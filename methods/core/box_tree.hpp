#pragma once

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Boxes around consecutive things, and boxes around `fan` of those, and so on.
struct BoxTree {
  static constexpr int fan = 8;
  static constexpr int most_levels = 12;
  int levels;                          ///< 0 for the smallest boxes
  const double* low[most_levels][3];   ///< by level and direction, padded to a multiple of
  const double* high[most_levels][3];  ///< `fan` by boxes that are empty: from inf to -inf
};

/// Lists the boxes of level 0 that come within `reach` of a box, ascending.
struct BoxesNear {
  const BoxTree* tree;
  int dim;
  double low[3], high[3];
  double reach;
  int* found;  ///< room for all boxes of level 0
  int* count;  ///< set to how many are found
};

STRONGPOINT_SIMD_KERNEL(list_boxes_near, BoxesNear);

}  // namespace strongpoint
