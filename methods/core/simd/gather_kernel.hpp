#pragma once

#include "methods/core/simd/path.hpp"
#include "methods/core/simd/stencil_table.hpp"

namespace strongpoint {

/// Gathers the stencils of a table, group after group of as many anchors as the path has lanes.
/// Within a group the numbers of all lanes lie side by side, node after node.
struct GatherTask {
  StencilTable table;
  int dim;           ///< 1 to 3
  double* z;         ///< (lane, Dim, n, group) positions relative to the anchor over R, at a
                     ///< cache line, as the next two
  double* rho;       ///< (lane, n, group) distances over R, 1 for padding
  double* radius;    ///< (lane, group) R
  unsigned* faulty;  ///< (group) bits of the lanes in which nodes are closer than 1e-10 R
};

/// Fills z, rho, radius and faulty.
STRONGPOINT_SIMD_KERNEL(gather_stencils, GatherTask);

}  // namespace strongpoint
