#pragma once

#include <cstdint>

/// Taylor fits of order 2 whose stencils all have the same size; no standard container, as the
/// rival is compiled with other options.
struct TaylorRivalTask {
  int dim;              ///< 2 or 3
  int size;             ///< n; the centre comes first, the farthest node last
  int count;            ///< stencils
  int derivatives;      ///< all first and second ones, or, `dim` of them, those of the Laplacian
  const double* nodes;  ///< (dim, count)
  const int* ids;       ///< (n, count)
  double* values;       ///< (derivatives, n, count) the weights
  double* conditions;   ///< (count) of the moment matrices, exact, in the 1-norm; null for none
  /// T^2 at distances over R; null where all weights are one.
  void (*weigh)(const double* distances, int size, double* squared);
};

/// Fills the weights by Eigen's PartialPivLU of each moment matrix. The library is built for the
/// processor at hand and shares no code with the rest.
extern "C" __attribute__((visibility("default"))) void taylor_rival_weights(
    const TaylorRivalTask* task);
