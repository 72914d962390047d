#pragma once

#include <cstdint>

/// Unweighted Taylor fits of order 2 whose stencils all have the same size; no standard container,
/// as the rival is compiled with other options.
struct TaylorRivalTask {
  int dim;              ///< 2 or 3
  int size;             ///< n: 15 in 2D, 30 in 3D; the centre comes first
  int count;            ///< stencils
  int derivatives;      ///< all first and second ones, or, `dim` of them, those of the Laplacian
  const double* nodes;  ///< (dim, count)
  const int* ids;       ///< (n, count)
  double* values;       ///< (derivatives, n, count) the weights
  double* conditions;   ///< (count) of the moment matrices, exact, in the 1-norm; null for none
};

/// Fills the weights by Eigen's PartialPivLU of each moment matrix.
void taylor_rival_weights(const TaylorRivalTask* task);
