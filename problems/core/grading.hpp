#pragma once

#include <algorithm>

namespace strongpoint {

/// How a spacing shrinks towards some place: h -> h (least + (1 - least) min(1, d / reach)), d the
/// distance from the place. The default changes nothing.
struct Grading {
  double least = 1;  ///< factor at the place itself, above 0 and at most 1
  double reach = 1;  ///< distance, above 0, from which on the spacing is as before

  /// The factor at a distance from the place.
  double factor(double distance) const {
    return least + (1 - least) * std::min(1.0, distance / reach);
  }
};

}  // namespace strongpoint
