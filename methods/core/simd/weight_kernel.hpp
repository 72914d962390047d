#pragma once

#include "methods/core/simd/path.hpp"
#include "methods/core/simd/weight_formula.hpp"

namespace strongpoint {

/// Distances to be weighed.
struct WeightTask {
  const WeightFormula* formula;
  const double* rho;  ///< (count) distances over R
  double* squared;    ///< (count) T^2
  long count;
};

/// Fills `squared`.
STRONGPOINT_SIMD_KERNEL(weigh_distances, WeightTask);

}  // namespace strongpoint
