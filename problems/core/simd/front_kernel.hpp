#pragma once

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Panels lie in tiles of so many vectors, whole numbers of every path's packs; those of a vector
/// that is missing are zeros.
template <class Real>
inline constexpr int front_tile = 192 / sizeof(Real);

/// What the kernel `eliminate_pivots` works on, in either precision: a dense front with pivots
/// somewhere in it.
template <class Real>
struct FrontTask {
  Real* front;  ///< (rest + pivots) rows; those that stay become C - A P^-1 B, in new places
  int stride;   ///< of its rows, at least rest + pivots and rest rounded up to tiles, as are rows
  int rest;     ///< rows that stay
  int pivots;   ///< rows of P
  const int* places;  ///< (pivots) of the pivots
  const int* from;    ///< (moves) places of what fills the gaps: all from `rest` on but pivots
  const int* to;      ///< (moves) places of pivots, below `rest`
  int moves;
  int* rows;     ///< (pivots) becomes the pivots' places in the order in which they are eliminated
  Real* block;   ///< (pivots, pivots) becomes the factors of Q P = L U, L without its unit diagonal
  int* swapped;  ///< (pivots) row k changed places with this one when it was eliminated
  Real* upper;   ///< (tiles, pivots, tile) becomes the rows of L^-1 Q B, B the pivots' rows
  Real* lower;   ///< (tiles, pivots, tile) becomes the columns of A U^-1, A the pivots' columns
  double* least_pivot;  ///< becomes the least diagonal entry of U, relative to what its column held
                        ///< in P; 0 when it is not a number, and the rest is not done
};

/// Eliminates the pivots of a front with partial pivoting among their own rows.
STRONGPOINT_SIMD_KERNEL(eliminate_pivots, FrontTask<double>);
STRONGPOINT_SIMD_KERNEL(eliminate_pivots, FrontTask<float>);

}  // namespace strongpoint
