#pragma once

#include <cstdint>

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Nearest nodes of a node, itself included, that `walk_cells` takes.
inline constexpr int most_walk_neighbours = 64;

/// What a walk around a cell found.
enum class WalkState : unsigned char {
  whole,      ///< the cell, a polyhedron
  unbounded,  ///< an edge without an end: the cell is not bounded by these neighbours
  broken      ///< no polyhedron: corners of four edges, or a node at the place of another one
};

/// Nodes in space whose Voronoi cells are wanted, and room for what is found.
struct WalkTask {
  const double* nodes;          ///< (3, N) coordinates, node after node
  const int* chosen;            ///< (count) the nodes whose cells are wanted
  const std::int64_t* offsets;  ///< (count + 1) into `ids`
  const int* ids;               ///< their nearest nodes by distance, themselves first
  int count;                    ///< how many cells
  int size;                     ///< nearest nodes of each, at most `most_walk_neighbours`
  double* volumes;              ///< (count)
  double* farthest_squared;     ///< (count) square of the largest distance of a vertex from the
                                ///< node; infinite unless the cell is whole
  WalkState* states;            ///< (count)
};

/// Finds the Voronoi cell of each node among its nearest nodes by following its edges, each to the
/// first bisector that crosses it: an edge costs a look at the neighbours that reach so far, and
/// none that was cut off again is ever made. A cell is whole when every edge has two ends, on the
/// same two faces, and vertices and faces satisfy Euler's formula. Farther nodes may cut it unless
/// 4 farthest_squared is at most the square of the distance to the last neighbour. Source: Brassel
/// and Reif 1979, A procedure to generate Thiessen polygons, carried over to space.
STRONGPOINT_SIMD_KERNEL(walk_cells, WalkTask);

}  // namespace strongpoint
