#pragma once

#include "methods/core/simd/stencil_table.hpp"
#include "methods/core/simd/weight_formula.hpp"

namespace strongpoint {

/// What weighs the nodes of a fit: the first that is not null; where all are, weights are ones.
struct NodeWeights {
  const WeightFormula* formula = nullptr;  ///< of the distance
  const double* volumes = nullptr;         ///< (N) T^2 of the nodes, in the units of the sites
  /// Fills T^2 of `count` distances over R; the centre's and those of padding are 1.
  void (*squared)(const void* function, const double* rho, double* squared, long count) = nullptr;
  const void* function = nullptr;
};

/// Stencils of Taylor fits, whose centre comes first, with room for what is gathered of a group.
struct TaylorStencils {
  StencilTable table;
  int dim;             ///< 1 to 3
  int order;           ///< highest degree of the monomials: 1 to 4, in 3D 1 to 3
  double least_pivot;  ///< over its diagonal entry
  double limit;        ///< of the 1-norm condition of the moment matrix
  NodeWeights weights;
  double* z;        ///< (lane, Dim, n), at a cache line as the next two
  double* rho;      ///< (lane, n)
  double* squared;  ///< (lane, n)
};

}  // namespace strongpoint
