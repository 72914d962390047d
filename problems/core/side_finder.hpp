#pragma once

#include "problems/core/convex_cell.hpp"
#include "problems/core/domain.hpp"

namespace strongpoint {

/// Tells which side of a domain a place on the boundary of a cell belongs to.
struct SideFinder {
  const PointCloud<2>& cloud;
  const Domain<2>& domain;
  int node;                      ///< whose cell it is
  const ConvexCell<2>& polygon;  ///< its edges labelled with the nodes beyond

  /// The side at x: one of the node's whose normal fits, or one of the nearest neighbour that lies
  /// on the boundary (it decides, too, between two sides of the node with one normal), or the one
  /// of all whose normal fits best.
  int side_at(const Point<2>& x, const Point<2>& normal) const;

 private:
  int nearest_marked_neighbour(const Point<2>& x) const;
};

}  // namespace strongpoint
