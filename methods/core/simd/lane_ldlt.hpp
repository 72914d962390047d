#pragma once

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Place of entry (i, j), j <= i, of a lower triangle stored row after row.
constexpr int triangle(int i, int j) { return i * (i + 1) / 2 + j; }

/// LDL^T without pivoting of definite matrices, one a lane: their lower triangles, row after row,
/// become L, and D^-1 on the diagonal. Returns the bits of the lanes in which every pivot is above
/// `tolerance` times its diagonal entry.
template <int Size>
[[gnu::always_inline]] inline unsigned factorise_ldlt(Pack* a, double tolerance) {
  unsigned good = every_lane;
  Pack bound[Size];
  for (int i = 0; i < Size; ++i) bound[i] = a[triangle(i, i)] * all(tolerance);
#pragma GCC unroll 16
  for (int k = 0; k < Size; ++k) {
    const Pack pivot = a[triangle(k, k)];
    good &= less(bound[k], pivot) & less(all(0), pivot);
    const Pack inverse = all(1) / pivot;
    a[triangle(k, k)] = inverse;
    Pack column[Size];
#pragma GCC unroll 16
    for (int i = k + 1; i < Size; ++i) column[i] = a[triangle(i, k)];
#pragma GCC unroll 16
    for (int i = k + 1; i < Size; ++i) {
      const Pack factor = column[i] * inverse;
      a[triangle(i, k)] = factor;
#pragma GCC unroll 16
      for (int j = k + 1; j <= i; ++j) a[triangle(i, j)] = a[triangle(i, j)] - factor * column[j];
    }
  }
  return good;
}

/// Inverses of definite matrices, one a lane, by factors: M^-1 = L^-T (D^-1 L^-1). Triangles are
/// stored row after row.
template <int Size>
struct InverseFactors {
  static constexpr int entries = Size * (Size + 1) / 2;
  Pack lower[entries];   ///< L^-1; what is on its diagonal, which is one, does not count
  Pack scaled[entries];  ///< D^-1 L^-1

  /// Fills both from what factorise_ldlt left.
  [[gnu::always_inline]] void take(const Pack* factor) {
#pragma GCC unroll 16
    for (int i = 0; i < Size; ++i) {
      const Pack pivot = factor[triangle(i, i)];
#pragma GCC unroll 16
      for (int j = 0; j < i; ++j) {
        Pack sum = factor[triangle(i, j)];
#pragma GCC unroll 16
        for (int k = j + 1; k < i; ++k) {
          sum = sum + factor[triangle(i, k)] * lower[triangle(k, j)];
        }
        lower[triangle(i, j)] = all(0) - sum;
        scaled[triangle(i, j)] = lower[triangle(i, j)] * pivot;
      }
      scaled[triangle(i, i)] = pivot;
    }
  }

  /// At least the square of the inverse's 1-norm, mostly by less than a factor of 16. An entry of a
  /// definite matrix M is at most sqrt(M_ii M_jj), so that the entries of a column add up to at
  /// most sqrt(M_jj) sum_i sqrt(M_ii), where the sum is at most sqrt(Size trace M).
  [[gnu::always_inline]] Pack square_bound() const {
    Pack trace = all(0);
    Pack largest = all(0);
#pragma GCC unroll 16
    for (int i = 0; i < Size; ++i) {
      Pack entry = scaled[triangle(i, i)];
#pragma GCC unroll 16
      for (int k = i + 1; k < Size; ++k) {
        entry = entry + scaled[triangle(k, i)] * lower[triangle(k, i)];
      }
      trace = trace + entry;
      largest = max(largest, entry);
    }
    return all(Size) * largest * trace;
  }

  /// The lower triangles of the inverses.
  [[gnu::always_inline]] void multiply(Pack* inverse) const {
#pragma GCC unroll 16
    for (int i = 0; i < Size; ++i) {
#pragma GCC unroll 16
      for (int j = 0; j <= i; ++j) {
        Pack sum = scaled[triangle(i, i)];
        if (j < i) sum = sum * lower[triangle(i, j)];
#pragma GCC unroll 16
        for (int k = i + 1; k < Size; ++k) {
          sum = sum + scaled[triangle(k, i)] * lower[triangle(k, j)];
        }
        inverse[triangle(i, j)] = sum;
      }
    }
  }

  /// The inverse times a right-hand side.
  [[gnu::always_inline]] void solve(const Pack* right_side, Pack* solution) const {
    Pack x[Size];
#pragma GCC unroll 16
    for (int k = 0; k < Size; ++k) {
      Pack t = scaled[triangle(k, 0)] * right_side[0];
#pragma GCC unroll 16
      for (int i = 1; i <= k; ++i) t = t + scaled[triangle(k, i)] * right_side[i];
      add_row(k, t, x);
    }
    for (int i = 0; i < Size; ++i) solution[i] = x[i];
  }

  /// The same, and the same bits, for a right-hand side that vanishes but for one entry.
  [[gnu::always_inline]] void solve_one(int place, Pack value, Pack* solution) const {
    Pack x[Size];
    for (int i = 0; i < Size; ++i) x[i] = all(0);
#pragma GCC unroll 16
    for (int k = 0; k < Size; ++k) {
      if (k >= place) add_row(k, scaled[triangle(k, place)] * value, x);
    }
    for (int i = 0; i < Size; ++i) solution[i] = x[i];
  }

 private:
  [[gnu::always_inline]] void add_row(int k, Pack factor, Pack* x) const {
#pragma GCC unroll 16
    for (int i = 0; i < k; ++i) x[i] = x[i] + lower[triangle(k, i)] * factor;
    x[k] = factor;
  }
};

/// The 1-norm of symmetric matrices given by their lower triangles.
template <int Size>
[[gnu::always_inline]] inline Pack norm_of_symmetric(const Pack* a) {
  Pack sums[Size];
  for (int i = 0; i < Size; ++i) sums[i] = all(0);
#pragma GCC unroll 16
  for (int i = 0; i < Size; ++i) {
#pragma GCC unroll 16
    for (int j = 0; j < i; ++j) {
      const Pack entry = abs(a[triangle(i, j)]);
      sums[i] = sums[i] + entry;
      sums[j] = sums[j] + entry;
    }
    sums[i] = sums[i] + abs(a[triangle(i, i)]);
  }
  Pack largest = sums[0];
  for (int i = 1; i < Size; ++i) largest = max(largest, sums[i]);
  return largest;
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
