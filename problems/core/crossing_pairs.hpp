#pragma once

#include <span>
#include <vector>

#include "methods/core/points.hpp"

namespace strongpoint {

/// Where a convex polygon crosses the boundary of a domain.
struct BoundaryCrossing {
  Point<2> x;
  Point<2> along;  ///< unit tangent of the boundary, the domain to its left
  bool leaves;     ///< whether the polygon, counter-clockwise, leaves the domain
};

/// A stretch of the boundary inside a polygon, given by the numbers of its crossings.
struct Stretch {
  int leaves, enters;
};

/// Finds which crossings are the ends of one stretch of the boundary. Stretches do not cross each
/// other; of all such ways to pair them the one is taken whose ends point at each other best, by
/// the sum of the cosines between tangents and chords. Beyond 5 pairs, each crossing is paired with
/// the next. Keeps its memory.
class CrossingPairs {
 public:
  /// Takes crossings in order around the polygon, leaving and entering in turns. Tangents matter
  /// only when there are more than two.
  void find(std::span<const BoundaryCrossing> crossings);
  /// What was found last.
  std::span<const Stretch> stretches() const { return best_; }

 private:
  std::vector<Stretch> best_, candidate_;
  std::vector<int> entries_;
};

}  // namespace strongpoint
