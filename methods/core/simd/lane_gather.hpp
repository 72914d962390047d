#pragma once

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
  unsigned coincident;  ///< bits of the lanes in which nodes are closer than 1e-10 R, or R is 0
};

/// As rho_i + rho_j <= 2, squares farther apart than this belong to distances that differ by more
/// than 1e-10.
inline constexpr double distinct_squares = 2e-10;

/// Bits of the lanes in which two nodes coincide, given the squares of their distances over R.
template <int Dim>
unsigned coincident_lanes(const LaneStencils& group, const Pack* squares, int size) {
  const Pack tolerance = all(1e-10);  // in units of R, as for stencils one by one
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

/// Where the nodes of a group lie.
struct LaneNodes {
  const int* ids[lanes];
  int counts[lanes];
  int least;  ///< nodes that every lane has
};

/// Fills `z`, not yet scaled, and the squares of the distances for nodes begin to end - 1; returns
/// the largest square.
template <int Dim, Padding padding>
[[gnu::always_inline]] inline Pack gather_nodes(const StencilTable& table, const LaneNodes& nodes,
                                                int begin, int end, const Pack* origin,
                                                const LaneStencils& group) {
  Pack largest = all(0);
  const double* const places = table.nodes;
  Pack* to = group.z + static_cast<long>(begin) * Dim;
  Pack* const squares = group.rho;
  for (int j = begin; j < end; ++j) {
    const double* node[lanes];
#pragma GCC unroll 8
    for (int lane = 0; lane < lanes; ++lane) {
      node[lane] = padding == Padding::none || j < nodes.counts[lane]
                       ? places + static_cast<long>(nodes.ids[lane][j]) * Dim
                       : table.anchors + static_cast<long>(group.anchors[lane]) * Dim;
    }
    Pack z[Dim];
    load_nodes<Dim>(node, z);
    Pack square = all(0);
    for (int c = 0; c < Dim; ++c) {
      z[c] = z[c] - origin[c];
      square = square + z[c] * z[c];
      *to++ = z[c];
    }
    squares[j] = square;
    largest = max(largest, square);
  }
  return largest;
}

/// Scales what `gather_nodes` found by the radius, and looks for nodes at one place.
template <int Dim>
[[gnu::always_inline]] inline void scale_nodes(int size, int least, Pack largest,
                                               LaneStencils& group) {
  const unsigned proper = less(all(0), largest);
  group.radius = choose(proper, sqrt(largest), all(1));
  const Pack inverse = all(1) / group.radius;
  Pack* const z = group.z;
  Pack* const rho = group.rho;
  for (int i = 0; i < size * Dim; ++i) z[i] = z[i] * inverse;
  const Pack sizes = group.size;
  const Pack by_square = inverse * inverse;
  Pack nearest = all(1);
  Pack before = all(-1);
  for (int j = 0; j < size; ++j) {
    Pack square = rho[j] * by_square;
    if (j >= least) square = choose(less(all(j), sizes), square, all(1));
    nearest = min(nearest, square - before);
    before = square;
    rho[j] = square;
  }
  group.coincident = every_lane & ~proper;
  // Nodes at one place are equally far away.
  if (less(nearest, all(distinct_squares)) != 0) {
    group.coincident |= coincident_lanes<Dim>(group, rho, size);
  }
}

/// Gathers the stencils of anchors `first` and following of a table as `gather_lanes` does, but
/// leaves the squares of the distances in `rho`.
template <int Dim>
void gather_squares(const StencilTable& table, int first, LaneStencils& group) {
  LaneNodes nodes;
  const double* anchor_place[lanes];
  double count[lanes];
  nodes.least = table.size;
  for (int lane = 0; lane < lanes; ++lane) {
    const int place = first + lane < table.count ? first + lane : table.count - 1;
    const int anchor = table.chosen[place];
    group.anchors[lane] = anchor;
    nodes.ids[lane] = table.ids + table.offsets[anchor];
    nodes.counts[lane] = static_cast<int>(table.offsets[anchor + 1] - table.offsets[anchor]);
    count[lane] = nodes.counts[lane];
    nodes.least = nodes.counts[lane] < nodes.least ? nodes.counts[lane] : nodes.least;
    anchor_place[lane] = table.anchors + static_cast<long>(anchor) * Dim;
  }
  // A load of what was stored in parts waits for all stores before it.
  group.size = nodes.least == table.size ? all(table.size) : load(count);
  Pack origin[Dim];
  load_nodes<Dim>(anchor_place, origin);
  fetch_ahead(anchor_place[0]);
  fetch_ahead(anchor_place[lanes / 2]);
  Pack largest = gather_nodes<Dim, Padding::none>(table, nodes, 0, nodes.least, origin, group);
  if (nodes.least < table.size) {
    const Pack rest =
        gather_nodes<Dim, Padding::some>(table, nodes, nodes.least, table.size, origin, group);
    largest = max(largest, rest);
  }
  scale_nodes<Dim>(table.size, nodes.least, largest, group);
}

/// Gathers the stencils of anchors `first` and following of a table; `lanes` of them or what is
/// left. `group.z` and `group.rho` point to room for n nodes.
template <int Dim>
void gather_lanes(const StencilTable& table, int first, LaneStencils& group) {
  gather_squares<Dim>(table, first, group);
  for (int j = 0; j < table.size; ++j) group.rho[j] = sqrt(group.rho[j]);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
