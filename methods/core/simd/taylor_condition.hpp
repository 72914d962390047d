#pragma once

#include "methods/core/simd/gather_kernel.hpp"

namespace strongpoint {

/// Taylor fits whose nodes have been gathered and whose conditions are wanted.
struct TaylorConditionTask {
  GatherTask gathered;
  int order;           ///< highest degree of the monomials
  double least_pivot;  ///< over its diagonal entry
  double limit;        ///< of the 1-norm condition of the moment matrix, for its inverse to count
  const double* squared;  ///< (lane, n, group) T^2, null for ones; those of centre and padding
                          ///< are not read
  const double* columns;  ///< (terms) factors of the columns of the moment matrix
  const int* powers;      ///< (terms) of R in the same
  double* scratch;        ///< at a cache line, lanes * n numbers
  double* one;            ///< (lane, group) the condition in the 1-norm
  double* maximum;        ///< (lane, group) the condition in the maximum norm
  unsigned* done;         ///< (group) bits of the lanes that were served
};

/// Fills one, maximum and done. Served are orders 1 to 4 in 1D and 2D, 1 to 3 in 3D.
STRONGPOINT_SIMD_KERNEL(judge_taylor, TaylorConditionTask);

}  // namespace strongpoint
