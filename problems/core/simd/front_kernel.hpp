#pragma once

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Panels have vectors of whole multiples of this many numbers, for the widest path.
inline constexpr int front_tile = 24;

/// What the kernel `eliminate_pivots` works on: a dense front [C B; A P], the pivots last.
struct FrontTask {
  double* front;  ///< (rest + pivots) rows; C becomes C - A P^-1 B, what lies behind it is spoiled
  int stride;     ///< of its rows, at least rest + pivots and rest rounded up to tiles
  int rest;       ///< rows of C
  int pivots;     ///< rows of P
  double*
      block;     ///< (pivots, pivots) becomes the factors of Q P = L U, L without its unit diagonal
  int* swapped;  ///< (pivots) row k changed places with this one when it was eliminated
  double* upper;  ///< (pivots, length) becomes the rows of L^-1 Q A, where A are those beside P
  double* lower;  ///< (pivots, length) becomes the columns of B U^-1, where B are those above P
  int length;     ///< rest rounded up to tiles
  double* least_pivot;  ///< becomes the least diagonal entry of U, relative to what its column held
                        ///< in P; 0 when it is not a number, and the rest is not done
};

/// Eliminates the pivots of a front with partial pivoting among their own rows.
STRONGPOINT_SIMD_KERNEL(eliminate_pivots, FrontTask);

}  // namespace strongpoint
