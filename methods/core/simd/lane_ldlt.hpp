#pragma once

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Place of entry (i, j), j <= i, of a lower triangle stored row after row.
constexpr int triangle(int i, int j) { return i * (i + 1) / 2 + j; }

/// Places of the entries of a symmetric matrix in its lower triangle.
template <int Size>
struct SymmetricPlaces {
  int of[Size][Size] = {};

  constexpr SymmetricPlaces() {
    for (int i = 0; i < Size; ++i) {
      for (int j = 0; j < Size; ++j) of[i][j] = i > j ? triangle(i, j) : triangle(j, i);
    }
  }
};
template <int Size>
inline constexpr SymmetricPlaces<Size> symmetric_places{};

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

/// The inverses of matrices from their factors, lower triangles too; `factor` is destroyed.
template <int Size>
[[gnu::always_inline]] inline void invert_ldlt(Pack* factor, Pack* inverse) {
  // L^-1 takes the place of L, row after row.
#pragma GCC unroll 16
  for (int i = 1; i < Size; ++i) {
#pragma GCC unroll 16
    for (int j = 0; j < i; ++j) {
      Pack sum = factor[triangle(i, j)];
#pragma GCC unroll 16
      for (int k = j + 1; k < i; ++k) {
        sum = sum + factor[triangle(i, k)] * factor[triangle(k, j)];
      }
      factor[triangle(i, j)] = all(0) - sum;
    }
  }
#pragma GCC unroll 16
  for (int i = 0; i < Size; ++i) {
    Pack column[Size];  // of D^-1 L^-1
#pragma GCC unroll 16
    for (int k = i + 1; k < Size; ++k) {
      column[k] = factor[triangle(k, i)] * factor[triangle(k, k)];
    }
#pragma GCC unroll 16
    for (int j = 0; j <= i; ++j) {
      Pack sum = factor[triangle(i, i)];
      if (j < i) sum = sum * factor[triangle(i, j)];
#pragma GCC unroll 16
      for (int k = i + 1; k < Size; ++k) sum = sum + column[k] * factor[triangle(k, j)];
      inverse[triangle(i, j)] = sum;
    }
  }
}

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
