#pragma once

#include "methods/core/simd/path.hpp"
#include "methods/core/simd/taylor_stencils.hpp"

namespace strongpoint {

/// Taylor fits whose conditions are wanted.
struct TaylorConditionTask {
  TaylorStencils stencils;  ///< within whose limits inverses count
  const double* columns;    ///< (terms) factors of the columns of the moment matrix
  const int* powers;        ///< (terms) of R in the same
  double* one;              ///< (lane, group) the condition in the 1-norm
  double* maximum;          ///< (lane, group) the condition in the maximum norm
  unsigned* done;           ///< (group) bits of the lanes that were served
};

/// Fills one, maximum and done.
STRONGPOINT_SIMD_KERNEL(judge_taylor, TaylorConditionTask);

}  // namespace strongpoint
