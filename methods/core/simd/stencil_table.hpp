#pragma once

#include <cstdint>

namespace strongpoint {

/// Stencils as kernels read them: pointers into sites and stencils.
struct StencilTable {
  const double* nodes;          ///< (Dim, N) coordinates, node after node
  const double* anchors;        ///< (Dim, A) likewise
  const std::int64_t* offsets;  ///< (A + 1) of the stencils in `ids`
  const int* ids;               ///< (entries) node ids, by distance within a stencil
  const int* chosen;            ///< (count) the anchors to be treated
  int count;                    ///< how many
  int size;                     ///< n, nodes in the largest of their stencils
};

}  // namespace strongpoint
