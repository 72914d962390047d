#include "problems/core/simd/front_kernel.hpp"

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// A tile of the front in registers: as many rows, and packs of columns.
constexpr int tile_rows = lanes == 8 ? 8 : 4;
constexpr int tile_packs = 3;
constexpr int tile_columns = tile_packs * lanes;
static_assert(front_tile % tile_columns == 0 && front_tile % tile_rows == 0);

/// Copies the parts of the front that belong to the pivots; panels are filled up with zeros.
void take_out(const FrontTask& t) {
  for (int k = 0; k < t.pivots; ++k) {
    const double* const row = t.front + static_cast<long>(t.rest + k) * t.stride;
    double* const upper = t.upper + static_cast<long>(k) * t.length;
    double* const lower = t.lower + static_cast<long>(k) * t.length;
    for (int c = 0; c < t.rest; ++c) upper[c] = row[c];
    for (int c = t.rest; c < t.length; ++c) upper[c] = lower[c] = 0;
    for (int c = 0; c < t.pivots; ++c) t.block[k * t.pivots + c] = row[t.rest + c];
  }
  for (int r = 0; r < t.rest; ++r) {
    const double* const row = t.front + static_cast<long>(r) * t.stride + t.rest;
    for (int k = 0; k < t.pivots; ++k) t.lower[static_cast<long>(k) * t.length + r] = row[k];
  }
}

void swap_rows(double* a, double* b, int count) {
  for (int i = 0; i < count; ++i) {
    const double kept = a[i];
    a[i] = b[i];
    b[i] = kept;
  }
}

/// Factorises the block; returns the least pivot relative to its column, 0 for one that is none.
double factorise(const FrontTask& t) {
  const int p = t.pivots;
  double least = 1;
  for (int k = 0; k < p; ++k) {
    double size = 0;
    for (int i = 0; i < k; ++i)
      size = size > __builtin_fabs(t.block[i * p + k]) ? size : __builtin_fabs(t.block[i * p + k]);
    int best = k;
    double largest = -1;
    for (int i = k; i < p; ++i) {
      const double entry = __builtin_fabs(t.block[i * p + k]);
      if (entry > largest) {
        largest = entry;
        best = i;
      }
    }
    size = size > largest ? size : largest;
    const bool is_fine = largest > 0 && largest <= __DBL_MAX__;
    if (!is_fine) return 0;
    if (largest < least * size) least = largest / size;
    t.swapped[k] = best;
    if (best != k) {
      swap_rows(t.block + k * p, t.block + best * p, p);
      swap_rows(t.upper + static_cast<long>(k) * t.length,
                t.upper + static_cast<long>(best) * t.length, t.length);
    }
    const double* const pivot_row = t.block + k * p;
    const double inverse = 1 / pivot_row[k];
    for (int i = k + 1; i < p; ++i) {
      double* const row = t.block + i * p;
      const double factor = row[k] * inverse;
      row[k] = factor;
      for (int c = k + 1; c < p; ++c) row[c] -= factor * pivot_row[c];
    }
  }
  return least;
}

/// Coefficients of a triangular solve over vectors: v_j = (v_j - sum of at(i, j) v_i, i < j) / d_j.
struct LowerUnit {  ///< rows of L^-1 A
  const double* block;
  int p;
  double at(int i, int j) const { return block[j * p + i]; }
  double inverse(int) const { return 1; }
};
struct UpperTurned {  ///< columns of B U^-1
  const double* block;
  int p;
  double at(int i, int j) const { return block[i * p + j]; }
  double inverse(int j) const { return 1 / block[j * p + j]; }
};

/// Solves for `Rows` vectors from `first` on, one tile of columns, those before being done.
template <int Rows, class Triangle>
void solve_rows(const Triangle& triangle, int first, double* vectors, long length) {
  Pack sums[Rows][tile_packs];
  for (int j = 0; j < Rows; ++j) {
    for (int q = 0; q < tile_packs; ++q)
      sums[j][q] = load(vectors + (first + j) * length + q * lanes);
  }
  for (int i = 0; i < first; ++i) {
    Pack known[tile_packs];
    for (int q = 0; q < tile_packs; ++q) known[q] = load(vectors + i * length + q * lanes);
    for (int j = 0; j < Rows; ++j) {
      const Pack factor = all(triangle.at(i, first + j));
      for (int q = 0; q < tile_packs; ++q) sums[j][q] = sums[j][q] - factor * known[q];
    }
  }
  for (int j = 0; j < Rows; ++j) {
    for (int i = 0; i < j; ++i) {
      const Pack factor = all(triangle.at(first + i, first + j));
      for (int q = 0; q < tile_packs; ++q) sums[j][q] = sums[j][q] - factor * sums[i][q];
    }
    const Pack inverse = all(triangle.inverse(first + j));
    for (int q = 0; q < tile_packs; ++q) {
      sums[j][q] = sums[j][q] * inverse;
      store(vectors + (first + j) * length + q * lanes, sums[j][q]);
    }
  }
}

template <class Triangle>
void solve_panel(const Triangle& triangle, int pivots, double* vectors, int length) {
  constexpr int rows = 4;
  for (int c = 0; c < length; c += tile_columns) {
    int first = 0;
    for (; first + rows <= pivots; first += rows) {
      solve_rows<rows>(triangle, first, vectors + c, length);
    }
    for (; first < pivots; ++first) solve_rows<1>(triangle, first, vectors + c, length);
  }
}

/// One tile of C loses the products of the panels.
void subtract_tile(const FrontTask& t, int r, int c) {
  double* const corner = t.front + static_cast<long>(r) * t.stride + c;
  const double* lower = t.lower + r;
  const double* upper = t.upper + c;
  Pack sums[tile_rows][tile_packs];
  for (int i = 0; i < tile_rows; ++i) {
    for (int q = 0; q < tile_packs; ++q) sums[i][q] = all(0);
  }
  for (int k = 0; k < t.pivots; ++k, lower += t.length, upper += t.length) {
    Pack row[tile_packs];
    for (int q = 0; q < tile_packs; ++q) row[q] = load(upper + q * lanes);
    for (int i = 0; i < tile_rows; ++i) {
      const Pack factor = all(lower[i]);
      for (int q = 0; q < tile_packs; ++q) sums[i][q] = sums[i][q] + factor * row[q];
    }
  }
  const int rows = t.rest - r < tile_rows ? t.rest - r : tile_rows;
  for (int i = 0; i < rows; ++i) {
    for (int q = 0; q < tile_packs; ++q) {
      double* const at = corner + static_cast<long>(i) * t.stride + q * lanes;
      store(at, load(at) - sums[i][q]);
    }
  }
}

}  // namespace

void eliminate_pivots(const FrontTask& task) {
  take_out(task);
  *task.least_pivot = factorise(task);
  const bool is_fine = *task.least_pivot > 0;
  if (!is_fine) return;
  solve_panel(LowerUnit{task.block, task.pivots}, task.pivots, task.upper, task.length);
  solve_panel(UpperTurned{task.block, task.pivots}, task.pivots, task.lower, task.length);
  for (int r = 0; r < task.rest; r += tile_rows) {
    for (int c = 0; c < task.rest; c += tile_columns) subtract_tile(task, r, c);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
