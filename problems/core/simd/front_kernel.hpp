#pragma once

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Panels lie in tiles of so many vectors, whole numbers of every path's packs; those of a vector
/// that is missing are zeros.
inline constexpr int front_tile = 24;

/// What the kernel `eliminate_pivots` works on: a dense front with pivots somewhere in it.
struct FrontTask {
  double* front;  ///< (rest + pivots) rows; those that stay become C - A P^-1 B, in new places
  int stride;     ///< of its rows, at least rest + pivots and rest rounded up to tiles, as are rows
  int rest;       ///< rows that stay
  int pivots;     ///< rows of P
  const int* places;  ///< (pivots) of the pivots
  const int* from;    ///< (moves) places of what fills the gaps: all from `rest` on but pivots
  const int* to;      ///< (moves) places of pivots, below `rest`
  int moves;
  int* rows;  ///< (pivots) becomes the pivots' places in the order in which they are eliminated
  double*
      block;     ///< (pivots, pivots) becomes the factors of Q P = L U, L without its unit diagonal
  int* swapped;  ///< (pivots) row k changed places with this one when it was eliminated
  double* upper;  ///< (tiles, pivots, tile) becomes the rows of L^-1 Q B, B the pivots' rows
  double* lower;  ///< (tiles, pivots, tile) becomes the columns of A U^-1, A the pivots' columns
  double* least_pivot;  ///< becomes the least diagonal entry of U, relative to what its column held
                        ///< in P; 0 when it is not a number, and the rest is not done
};

/// Eliminates the pivots of a front with partial pivoting among their own rows.
STRONGPOINT_SIMD_KERNEL(eliminate_pivots, FrontTask);

/// What products with a panel work on.
struct PanelTask {
  const double* panel;  ///< (tiles, pivots, tile), as in `FrontTask`
  int rest;             ///< vectors in it
  int pivots;
  double* values;  ///< (pivots)
  double* beside;  ///< (rest rounded up to tiles)
};

/// The sum over the pivots of their value times the panel's numbers becomes `beside`.
STRONGPOINT_SIMD_KERNEL(multiply_panel, PanelTask);

/// The sum over what is `beside`, zeros in the end, times the panel's numbers is taken from
/// `values`.
STRONGPOINT_SIMD_KERNEL(subtract_turned_panel, PanelTask);

}  // namespace strongpoint
