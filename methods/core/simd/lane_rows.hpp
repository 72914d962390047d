#pragma once

#include "methods/core/simd/lane_points.hpp"
#include "methods/core/simd/lane_scatter.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Writes the weights of the p-th points of some lanes: rows (per_entry, n), node after node. Lanes
/// in which one of them is not finite are left out; returns the bits of the others.
template <int Dim>
unsigned write_finite_rows(const LanePoints<Dim>& points, long p, unsigned some, const Pack* rows,
                           int nodes, int per_entry) {
  // Not numbers if any weight is not finite; several, as each sum waits for the one before.
  Pack checks[4] = {all(0), all(0), all(0), all(0)};
  const long count = static_cast<long>(nodes) * per_entry;
  long e = 0;
  for (; e + 4 <= count; e += 4) {
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) checks[i] = checks[i] + rows[e + i] * all(0);
  }
  for (; e < count; ++e) checks[0] = checks[0] + rows[e] * all(0);
  some &= less((checks[0] + checks[1]) + (checks[2] + checks[3]), all(1));
  LaneRows to = points.rows(p, some, per_entry);
  scatter_lanes(rows, to.least, to.to, some);
  for (int lane = 0; lane < lanes; ++lane) {
    if ((some >> lane & 1U) == 0 || to.entries[lane] <= to.least) continue;
    to.to[lane] += to.least;
    scatter_lanes(rows + to.least, to.entries[lane] - to.least, to.to, 1U << lane);
  }
  return some;
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
