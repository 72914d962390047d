#pragma once

#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/stencil_table.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// The stencils of a group of anchors, one a lane, in coordinates scaled by their radii.
struct LaneStencils {
  Pack* z;              ///< (Dim, n) positions relative to the anchor over R, node after node
  Pack* rho;            ///< (n) distances over R, ascending
  Pack radius;          ///< R, the largest distance; 1 in lanes without any
  int anchors[lanes];   ///< the last one repeated where the group is not full
  unsigned coincident;  ///< bits of the lanes in which nodes are closer than 1e-10 R, or R is 0
};

/// Bits of the lanes in which two nodes coincide.
template <int Dim>
unsigned coincident_lanes(const Pack* z, const Pack* rho, int size) {
  const Pack tolerance = all(1e-10);  // in units of R, as for stencils one by one
  unsigned found = 0;
  for (int i = 0; i + 1 < size; ++i) {
    for (int j = i + 1; j < size; ++j) {
      if (less(tolerance, rho[j] - rho[i]) == every_lane) break;
      Pack largest = all(0);
      for (int c = 0; c < Dim; ++c) largest = max(largest, abs(z[j * Dim + c] - z[i * Dim + c]));
      found |= less(largest, tolerance);
    }
  }
  return found;
}

/// Gathers the stencils of anchors `first` and following of a table; `lanes` of them or what is
/// left. `group.z` and `group.rho` point to room for n nodes.
template <int Dim>
void gather_lanes(const StencilTable& table, int first, LaneStencils& group) {
  const int* ids[lanes];
  Pack origin[Dim];
  for (int lane = 0; lane < lanes; ++lane) {
    const int place = first + lane < table.count ? first + lane : table.count - 1;
    group.anchors[lane] = table.chosen[place];
    ids[lane] = table.ids + table.offsets[group.anchors[lane]];
  }
  double buffer[Dim][lanes];
  for (int c = 0; c < Dim; ++c) {
    for (int lane = 0; lane < lanes; ++lane) {
      buffer[c][lane] = table.anchors[static_cast<long>(group.anchors[lane]) * Dim + c];
    }
    origin[c] = load(buffer[c]);
  }
  Pack largest = all(0);
  for (int j = 0; j < table.size; ++j) {
    for (int lane = 0; lane < lanes; ++lane) {
      const double* const node = table.nodes + static_cast<long>(ids[lane][j]) * Dim;
      for (int c = 0; c < Dim; ++c) buffer[c][lane] = node[c];
    }
    Pack square = all(0);
    for (int c = 0; c < Dim; ++c) {
      const Pack offset = load(buffer[c]) - origin[c];
      group.z[j * Dim + c] = offset;
      square = square + offset * offset;
    }
    group.rho[j] = sqrt(square);
    largest = max(largest, group.rho[j]);
  }
  const unsigned proper = less(all(0), largest);
  group.radius = choose(proper, largest, all(1));
  const Pack inverse = all(1) / group.radius;
  for (int i = 0; i < table.size * Dim; ++i) group.z[i] = group.z[i] * inverse;
  for (int j = 0; j < table.size; ++j) group.rho[j] = group.rho[j] * inverse;
  group.coincident = (every_lane & ~proper) | coincident_lanes<Dim>(group.z, group.rho, table.size);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
