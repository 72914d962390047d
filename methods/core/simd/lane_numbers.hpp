#pragma once

#include "methods/core/simd/lane_anchors.hpp"
#include "methods/core/simd/monomial_list.hpp"
#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/stencil_table.hpp"

// For kernel sources only: numbers of anchors and nodes, and monomials, brought into lanes.

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// A number of each anchor of a group.
inline Pack gather_of_anchors(const StencilTable& table, int first, const double* numbers) {
  const LaneAnchors anchors = anchors_of(table, first);
  const double* place[lanes];
  for (int lane = 0; lane < lanes; ++lane) place[lane] = numbers + anchors.of[lane];
  Pack gathered;
  load_nodes<1>(place, &gathered);
  return gathered;
}

/// A number of each node of a group's stencils, node after node, times a factor; zero in padding.
inline void gather_of_nodes(const StencilTable& table, int first, const double* numbers,
                            Pack factor, Pack* to) {
  const LaneAnchors anchors = anchors_of(table, first);
  const double zero = 0;
  const double* place[lanes];
  for (int j = 0; j < table.size; ++j) {
    for (int lane = 0; lane < lanes; ++lane) {
      const std::int64_t* const offsets = table.offsets + anchors.of[lane];
      const bool is_padding = j >= offsets[1] - offsets[0];
      place[lane] = is_padding ? &zero : numbers + table.ids[offsets[0] + j];
    }
    Pack gathered;
    load_nodes<1>(place, &gathered);
    to[j] = gathered * factor;
  }
}

/// Bits of the lanes that hold an anchor of their own.
inline unsigned lanes_in_use(const StencilTable& table, int first) {
  const int count = table.count - first;
  return count < lanes ? (1U << count) - 1 : every_lane;
}

/// The monomials of a list at z.
inline void evaluate_list(MonomialList list, const Pack* z, Pack* values) {
  for (int a = 0; a < list.terms; ++a) {
    const int axis = list.axis[a];
    const int parent = list.parent[a];
    values[a] = axis < 0 ? all(1) : parent < 0 ? z[axis] : values[parent] * z[axis];
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
