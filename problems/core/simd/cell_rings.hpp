#pragma once

#include <cstdint>

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Nodes of the plane whose Voronoi cells are wanted, and room for what is found.
struct RingTask {
  const double* nodes;          ///< (2, N) coordinates, node after node
  const int* chosen;            ///< (count) the nodes whose cells are wanted
  const std::int64_t* offsets;  ///< (count + 1) into `ids`
  const int* ids;            ///< the chosen nodes' nearest nodes, themselves included, by distance
  int count;                 ///< how many cells
  int size;                  ///< nearest nodes of each, at most `most_ring_neighbours`
  double* areas;             ///< (count) of the cells
  double* farthest_squared;  ///< (count) square of the largest distance of a corner from the node
  int* ring_sizes;           ///< (count) corners of each cell; nullptr: rings are not wanted
  int* ring_places;  ///< (count, most_ring_corners) places in the list of nearest nodes of those
                     ///< whose edges leave the corners, counter-clockwise
  double* ring_corners;  ///< (count, most_ring_corners, 2) corners relative to the node
};

inline constexpr int most_ring_neighbours = 64;
inline constexpr int most_ring_corners = 24;

/// Finds the Voronoi cell of each node among its nearest nodes by walking around it: from the
/// nearest node on, along each bisector to the first other one that crosses it. Cells that are not
/// bounded, have more than `most_ring_corners` corners or whose node coincides with another one are
/// given an infinite `farthest_squared`. Farther nodes may cut a cell unless 4 farthest_squared is
/// at most the square of the distance to the last neighbour. Source: Brassel and Reif 1979, A
/// procedure to generate Thiessen polygons, for several nodes side by side.
STRONGPOINT_SIMD_KERNEL(find_cell_rings, RingTask);

}  // namespace strongpoint
