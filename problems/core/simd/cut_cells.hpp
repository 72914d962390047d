#pragma once

#include <cstdint>

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// A convex polyhedron about the origin in which three edges meet at every vertex; coinciding
/// vertices stand for a corner of more. An edge is held from both ends: e = 4 v + s leaves vertex v
/// in slot s of 3, slots counter-clockwise seen from outside.
struct CutCell {
  static constexpr int most_vertices = 128;
  static constexpr int most_faces = 250;

  double x[most_vertices], y[most_vertices], z[most_vertices];  ///< 0 beyond `vertices`
  double squared[most_vertices];           ///< distance from the origin; 0 beyond `vertices`
  double height[most_vertices];            ///< above the plane tried last
  unsigned short twin[4 * most_vertices];  ///< the same edge from its other end
  unsigned char face[4 * most_vertices];   ///< to the left of an edge as it leaves
  unsigned char crossing[most_faces + 1];  ///< of faces by the plane tried last
  double foot[most_faces][3];              ///< of the perpendicular on a face from the origin
  int label[most_faces];                   ///< of what made a face
  int vertices = 0;
  int faces = 0;         ///< planes that made or once made one
  double tolerance = 0;  ///< heights up to this lie on the plane
};

/// What became of a cell.
enum class CutState : unsigned char {
  whole,  ///< made
  broken  ///< round-off spoilt it, or it has too many vertices: cut it another way
};

/// A half-space to cut with before the neighbours: normal.x <= 0.
struct SidePlane {
  double normal[3];
  int label;
};

/// Nodes in space whose Voronoi cells are wanted, and room for what is found.
struct CutTask {
  const double* nodes;          ///< (3, N) coordinates, node after node
  const int* chosen;            ///< (count) the nodes whose cells are wanted
  const std::int64_t* offsets;  ///< (count + 1) into `ids`
  const int* ids;               ///< their neighbours by distance, with or without themselves
  int count;                    ///< how many cells
  const SidePlane* planes;      ///< (plane_count) for all of them
  int plane_count;
  const double* half_widths;  ///< (count) of the cubes that cells start as
  CutCell* work;              ///< overwritten; holds the last cell afterwards
  double* volumes;            ///< (count); nullptr: not wanted
  double* farthest_squared;   ///< (count) square of the largest distance of a vertex from the node
  CutState* states;           ///< (count)
};

/// Cuts the cell of each node out of a cube by the bisectors of its neighbours in order of
/// distance until the security radius: no node farther away than twice the farthest vertex can cut.
STRONGPOINT_SIMD_KERNEL(cut_cells, CutTask);

/// A cut of a cell that is there.
struct FurtherCut {
  CutCell* cell;
  SidePlane plane;  ///< its normal has unit length
  double offset;    ///< keeps normal.x <= offset
  CutState* state;  ///< broken where nothing is left, too
};

/// Cuts a cell once more.
STRONGPOINT_SIMD_KERNEL(cut_further, FurtherCut);

/// How large a cell is.
struct ExtentTask {
  const CutCell* cell;
  double* volume;
  double* farthest_squared;  ///< square of the largest distance of a vertex from the origin
};

/// Measures a cell.
STRONGPOINT_SIMD_KERNEL(measure_cell, ExtentTask);

}  // namespace strongpoint
