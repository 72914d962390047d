#pragma once

#include "methods/core/simd/lane_algebra.hpp"

// For kernel sources only: LU of small matrices, one in each lane, without exchanges, and a bound
// of what that costs. The order of all sums is that of the rows, whatever their number: a block
// triangular matrix gives its last blocks the same bits with and without the first.

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Factorises A = L U in place, L unit lower, without exchanges. `inverse` (size) becomes that of
/// the diagonal of U; it is not finite, or what comes of it is large, where a pivot is too small.
inline void factorise_lu(int size, const LaneMatrix& a, Pack* inverse) {
  for (int k = 0; k < size; ++k) {
    const Pack reciprocal = all(1) / a(k, k);
    inverse[k] = reciprocal;
    for (int i = k + 1; i < size; ++i) {
      const Pack factor = a(i, k) * reciprocal;
      a(i, k) = factor;
      for (int j = k + 1; j < size; ++j) a(i, j) = a(i, j) - factor * a(k, j);
    }
  }
}

/// x(i, c) -= a(i, k) x(k, c) for k from `begin` to `end` - 1 and all columns.
inline void subtract_rows(int i, int begin, int end, const LaneMatrix& a, int columns,
                          const LaneMatrix& x) {
  for (int c = 0; c < columns; ++c) {
    Pack sum = x(i, c);
    for (int k = begin; k < end; ++k) sum = sum - a(i, k) * x(k, c);
    x(i, c) = sum;
  }
}

/// Solves A x = b for all columns, b (size, columns) becoming x.
inline void solve_lu(int size, const LaneMatrix& lu, const Pack* inverse, int columns,
                     const LaneMatrix& x) {
  for (int i = 0; i < size; ++i) subtract_rows(i, 0, i, lu, columns, x);
  for (int i = size - 1; i >= 0; --i) {
    subtract_rows(i, i + 1, size, lu, columns, x);
    for (int c = 0; c < columns; ++c) x(i, c) = x(i, c) * inverse[i];
  }
}

/// The same of A^T x = b.
inline void solve_transposed(int size, const LaneMatrix& lu, const Pack* inverse, int columns,
                             const LaneMatrix& x) {
  const LaneMatrix turned = lu.transposed();
  for (int i = 0; i < size; ++i) {
    subtract_rows(i, 0, i, turned, columns, x);
    for (int c = 0; c < columns; ++c) x(i, c) = x(i, c) * inverse[i];
  }
  for (int i = size - 1; i >= 0; --i) subtract_rows(i, i + 1, size, turned, columns, x);
}

/// The norm of |A^-1| |L| |U| by its largest row sum. Round-off of a factorisation without
/// exchanges is that of solving systems of this condition, whatever the scales of the rows: it is
/// the condition of Skeel, |A^-1| |A|, but for the growth of the factors. Not a number where these
/// are not finite. Source: Higham 2002, theorem 9.3. `room` holds (size + 1, size) numbers.
inline Pack growth_condition(int size, const LaneMatrix& lu, const Pack* inverse, Pack* room) {
  Pack* const products = room;
  const LaneMatrix inverted{room + size, size, 1};
  for (int i = 0; i < size; ++i) {
    Pack sum = all(0);
    for (int j = i; j < size; ++j) sum = sum + abs(lu(i, j));
    products[i] = sum;
    for (int j = 0; j < size; ++j) inverted(i, j) = all(i == j ? 1 : 0);
  }
  for (int i = size - 1; i >= 0; --i) {  // products of L need those before
    Pack sum = products[i];
    for (int j = 0; j < i; ++j) sum = sum + abs(lu(i, j)) * products[j];
    products[i] = sum;
  }
  solve_lu(size, lu, inverse, size, inverted);
  Pack check = all(0);  // not a number if one of the sums is none
  Pack largest = all(0);
  for (int i = 0; i < size; ++i) {
    Pack sum = all(0);
    for (int j = 0; j < size; ++j) sum = sum + abs(inverted(i, j)) * products[j];
    largest = max(largest, sum);
    check = check + sum * all(0);
  }
  return largest + check;
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
