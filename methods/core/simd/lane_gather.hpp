#pragma once

#include "methods/core/simd/lane_anchors.hpp"
#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/stencil_table.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// The stencils of a group of anchors, one a lane, in coordinates scaled by their radii. A stencil
/// smaller than the table's size is padded with copies of its anchor.
struct LaneStencils {
  Pack radius;          ///< R, the largest distance; 1 in lanes without any
  Pack size;            ///< nodes in each lane's stencil
  Pack* z;              ///< (Dim, n) positions relative to the anchor over R, node after node
  Pack* rho;            ///< (n) distances over R, ascending; 1 for padding
  int anchors[lanes];   ///< the last one repeated where the group is not full
  int least;            ///< nodes that every lane has
  unsigned coincident;  ///< bits of the lanes in which nodes are closer than 1e-10 R, or R is 0
};

/// As rho_i + rho_j <= 2, squares farther apart than this belong to distances that differ by more
/// than 1e-10.
inline constexpr double distinct_squares = 2e-10;

/// Coincident nodes are closer than this, in units of R, as for stencils one by one.
inline constexpr double coincident_distance = 1e-10;

/// A number of a node that changes by at most `mark_growth` times the largest change of its
/// coordinates, and that tells the nodes of a lattice apart: no sum of multiples of its factors is
/// zero. They are powers of the inverse plastic number, the root of x^3 = x + 1.
template <int Dim>
[[gnu::always_inline]] inline Pack mark_of(const Pack* z) {
  Pack mark = z[0];
  if constexpr (Dim > 1) mark = mark + all(0.7548776662466927) * z[1];
  if constexpr (Dim > 2) mark = mark + all(0.5698402909980532) * z[2];
  return mark;
}
inline constexpr double mark_growth = 2.4;

/// Whether two nodes may coincide: they are equally far away, and their marks are the same. Most
/// nodes of a lattice are as far away as others.
template <int Dim>
bool may_coincide(const LaneStencils& group, const Pack* squares, int size) {
  constexpr int most = 64;  // equally far away, of which the marks are kept
  Pack marks[most];
  Pack nearest = all(1);
  for (int begin = 0, end = 0; begin < size; begin = end) {
    marks[0] = mark_of<Dim>(group.z + static_cast<long>(begin) * Dim);
    for (end = begin + 1; end < size; ++end) {
      const int count = end - begin;
      if (less(squares[end] - squares[end - 1], all(distinct_squares)) == 0) break;
      if (count == most) return true;
      const Pack mark = mark_of<Dim>(group.z + static_cast<long>(end) * Dim);
      for (int i = 0; i < count; ++i) nearest = min(nearest, abs(mark - marks[i]));
      marks[count] = mark;
    }
  }
  return less(nearest, all(mark_growth * coincident_distance)) != 0;
}

/// Bits of the lanes in which two nodes coincide, given the squares of their distances over R.
template <int Dim>
unsigned coincident_lanes(const LaneStencils& group, const Pack* squares, int size) {
  const Pack tolerance = all(coincident_distance);
  const Pack apart = all(distinct_squares);
  unsigned found = 0;
  for (int i = 0; i + 1 < size; ++i) {
    for (int j = i + 1; j < size; ++j) {
      const unsigned real = less(all(j), group.size);
      const unsigned near = real & ~less(apart, squares[j] - squares[i]);
      if (near == 0) break;
      Pack largest = all(0);
      for (int c = 0; c < Dim; ++c) {
        largest = max(largest, abs(group.z[j * Dim + c] - group.z[i * Dim + c]));
      }
      found |= near & less(largest, tolerance);
    }
  }
  return found;
}

/// Whether some lanes have fewer nodes.
enum class Padding { none, some };

/// Where the nodes of a group lie, and how they are scaled.
template <int Dim>
struct LaneNodes {
  const int* ids[lanes];
  int counts[lanes];
  int least;  ///< nodes that every lane has
  const double* anchors[lanes];
  Pack origin[Dim];
  Pack inverse;    ///< 1 / R
  Pack by_square;  ///< of that
};

/// What is found of a group on the way.
struct LaneDistances {
  Pack largest;  ///< square
  Pack before;   ///< square over R^2 of the node before
  Pack nearest;  ///< least difference of two that follow each other
};

template <int Dim>
[[gnu::always_inline]] inline Pack square_of(const Pack* z) {
  Pack square = all(0);
  for (int c = 0; c < Dim; ++c) square = square + z[c] * z[c];
  return square;
}

/// Fills `z` and the squares of the distances over R for nodes begin to end - 1.
template <int Dim, Padding padding>
[[gnu::always_inline]] inline void gather_nodes(const double* places, const LaneNodes<Dim>& nodes,
                                                int begin, int end, const LaneStencils& group,
                                                LaneDistances& found) {
  LaneDistances distances = found;
  const Pack inverse = nodes.inverse;
  const Pack by_square = nodes.by_square;
  const Pack sizes = group.size;
  Pack* to = group.z + static_cast<long>(begin) * Dim;
  Pack* const squares = group.rho;
  for (int j = begin; j < end; ++j) {
    const double* node[lanes];
#pragma GCC unroll 8
    for (int lane = 0; lane < lanes; ++lane) {
      node[lane] = padding == Padding::none || j < nodes.counts[lane]
                       ? places + static_cast<long>(nodes.ids[lane][j]) * Dim
                       : nodes.anchors[lane];
    }
    Pack z[Dim];
    load_nodes<Dim>(node, z);
    for (int c = 0; c < Dim; ++c) z[c] = z[c] - nodes.origin[c];
    Pack square = square_of<Dim>(z);
    distances.largest = max(distances.largest, square);
    square = square * by_square;
    if (padding == Padding::some) square = choose_less(all(j), sizes, square, all(1));
    for (int c = 0; c < Dim; ++c) *to++ = z[c] * inverse;
    squares[j] = square;
    distances.nearest = min(distances.nearest, square - distances.before);
    distances.before = square;
  }
  found = distances;
}

/// Finds the nodes of anchors `first` and following of a table.
template <int Dim>
[[gnu::always_inline]] inline void find_nodes(const StencilTable& table, int first,
                                              LaneNodes<Dim>& nodes, LaneStencils& group) {
  const LaneAnchors anchors = anchors_of(table, first);
  double count[lanes];
  nodes.least = table.size;
  for (int lane = 0; lane < lanes; ++lane) {
    const int anchor = anchors.of[lane];
    group.anchors[lane] = anchor;
    nodes.anchors[lane] = table.anchors + static_cast<long>(anchor) * Dim;
  }
  if (anchors.in_a_row) {
    for (int lane = 0; lane < lanes; ++lane) {
      nodes.ids[lane] = anchors.ids + static_cast<long>(lane) * table.size;
      nodes.counts[lane] = table.size;
    }
  } else {
    for (int lane = 0; lane < lanes; ++lane) {
      const std::int64_t* const offsets = table.offsets + anchors.of[lane];
      nodes.ids[lane] = table.ids + offsets[0];
      nodes.counts[lane] = static_cast<int>(offsets[1] - offsets[0]);
      count[lane] = nodes.counts[lane];
      nodes.least = nodes.counts[lane] < nodes.least ? nodes.counts[lane] : nodes.least;
    }
  }
  group.least = nodes.least;
  // A load of what was stored in parts waits for all stores before it.
  group.size = nodes.least == table.size ? all(table.size) : load(count);
  load_nodes<Dim>(nodes.anchors, nodes.origin);
}

/// Squares of the distances of the last nodes, which are the farthest.
template <int Dim>
[[gnu::always_inline]] inline Pack last_squares(const double* places, const LaneNodes<Dim>& nodes) {
  const double* node[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    node[lane] = places + static_cast<long>(nodes.ids[lane][nodes.counts[lane] - 1]) * Dim;
  }
  Pack z[Dim];
  load_nodes<Dim>(node, z);
  for (int c = 0; c < Dim; ++c) z[c] = z[c] - nodes.origin[c];
  return square_of<Dim>(z);
}

/// Gathers the stencils of anchors `first` and following of a table as `gather_lanes` does, but
/// leaves the squares of the distances in `rho`.
template <int Dim>
void gather_squares(const StencilTable& table, int first, LaneStencils& group) {
  LaneNodes<Dim> nodes;
  find_nodes<Dim>(table, first, nodes, group);
  fetch_ahead(nodes.anchors[0]);
  fetch_ahead(nodes.anchors[lanes / 2]);
  LaneDistances found{last_squares<Dim>(table.nodes, nodes), all(-1), all(1)};
  Pack farthest;
  do {
    farthest = found.largest;
    const unsigned proper = less(all(0), farthest);
    group.radius = choose(proper, sqrt(farthest), all(1));
    group.coincident = every_lane & ~proper;
    nodes.inverse = all(1) / group.radius;
    nodes.by_square = nodes.inverse * nodes.inverse;
    found = {farthest, all(-1), all(1)};
    gather_nodes<Dim, Padding::none>(table.nodes, nodes, 0, nodes.least, group, found);
    if (nodes.least < table.size) {
      gather_nodes<Dim, Padding::some>(table.nodes, nodes, nodes.least, table.size, group, found);
    }
    // Nodes that round-off alone tells apart may have changed places.
  } while (less(farthest, found.largest) != 0);
  // Nodes at one place are equally far away. Padding would seem to coincide.
  if (less(found.nearest, all(distinct_squares)) != 0 &&
      (nodes.least < table.size || may_coincide<Dim>(group, group.rho, table.size))) {
    group.coincident |= coincident_lanes<Dim>(group, group.rho, table.size);
  }
}

/// Gathers the stencils of anchors `first` and following of a table; `lanes` of them or what is
/// left. `group.z` and `group.rho` point to room for n nodes.
template <int Dim>
void gather_lanes(const StencilTable& table, int first, LaneStencils& group) {
  gather_squares<Dim>(table, first, group);
  for (int j = 0; j < table.size; ++j) group.rho[j] = sqrt(group.rho[j]);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
