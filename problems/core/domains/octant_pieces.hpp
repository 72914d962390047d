#pragma once

#include <array>
#include <functional>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// A surface around the origin, given by its point on the ray through q.
using RadialSurface = std::function<Point<3>(const Point<3>& q)>;

/// Sides that the pieces of an octant belong to.
struct OctantSides {
  int inner;
  std::array<int, 3> outer;   ///< on the faces x, y and z = const of the box
  std::array<int, 3> planes;  ///< x = 0, y = 0, z = 0
};

/// Pieces of the part x, y, z >= 0 between two surfaces around the origin. Each surface is cut
/// where the rays through the edges of the box from 0 to `corner` meet it, into three pieces
/// without a collapsed rim; each coordinate plane is cut in two by the ray through the box's
/// corner.
std::vector<BoundaryPiece<3>> octant_pieces(const Point<3>& corner, const RadialSurface& inner,
                                            const RadialSurface& outer, const OctantSides& sides);

}  // namespace strongpoint
