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

/// Bits of the lanes in which two nodes coincide, given the squares of their distances over R.
template <int Dim>
unsigned coincident_lanes(const LaneStencils& group, const Pack* squares, int size) {
  const Pack tolerance = all(1e-10);  // in units of R, as for stencils one by one
  // As rho_i + rho_j <= 2, squares farther apart than this belong to distances that differ by more.
  const Pack apart = all(2e-10);
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

/// Gathers the stencils of anchors `first` and following of a table as `gather_lanes` does, but
/// leaves the squares of the distances in `rho`.
template <int Dim>
void gather_squares(const StencilTable& table, int first, LaneStencils& group) {
  const int* ids[lanes];
  const double* node[lanes];
  int counts[lanes];
  double count[lanes];
  int least = table.size;  // nodes that every lane has
  Pack origin[Dim];
  for (int lane = 0; lane < lanes; ++lane) {
    const int place = first + lane < table.count ? first + lane : table.count - 1;
    const int anchor = table.chosen[place];
    group.anchors[lane] = anchor;
    ids[lane] = table.ids + table.offsets[anchor];
    counts[lane] = static_cast<int>(table.offsets[anchor + 1] - table.offsets[anchor]);
    count[lane] = counts[lane];
    least = counts[lane] < least ? counts[lane] : least;
    node[lane] = table.anchors + static_cast<long>(anchor) * Dim;
  }
  group.size = load(count);
  load_nodes<Dim>(node, origin);
  Pack largest = all(0);
  for (int j = 0; j < table.size; ++j) {
#pragma GCC unroll 8
    for (int lane = 0; lane < lanes; ++lane) {
      node[lane] = j < least || j < counts[lane]
                       ? table.nodes + static_cast<long>(ids[lane][j]) * Dim
                       : table.anchors + static_cast<long>(group.anchors[lane]) * Dim;
    }
    Pack* const z = group.z + static_cast<long>(j) * Dim;
    load_nodes<Dim>(node, z);
    Pack square = all(0);
    for (int c = 0; c < Dim; ++c) {
      z[c] = z[c] - origin[c];
      square = square + z[c] * z[c];
    }
    group.rho[j] = square;
    largest = max(largest, square);
  }
  const unsigned proper = less(all(0), largest);
  group.radius = choose(proper, sqrt(largest), all(1));
  const Pack inverse = all(1) / group.radius;
  for (int i = 0; i < table.size * Dim; ++i) group.z[i] = group.z[i] * inverse;
  for (int j = 0; j < table.size; ++j) {
    group.rho[j] = choose(less(all(j), group.size), group.rho[j] * inverse * inverse, all(1));
  }
  group.coincident = (every_lane & ~proper) | coincident_lanes<Dim>(group, group.rho, table.size);
}

/// Gathers the stencils of anchors `first` and following of a table; `lanes` of them or what is
/// left. `group.z` and `group.rho` point to room for n nodes.
template <int Dim>
void gather_lanes(const StencilTable& table, int first, LaneStencils& group) {
  gather_squares<Dim>(table, first, group);
  for (int j = 0; j < table.size; ++j) group.rho[j] = sqrt(group.rho[j]);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
