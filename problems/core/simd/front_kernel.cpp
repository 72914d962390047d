#include "problems/core/simd/front_kernel.hpp"

#include "problems/core/simd/real_packs.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// A tile of the front in registers: as many rows, and packs of columns.
constexpr int tile_rows = lanes == 8 ? 8 : 4;
constexpr int tile_packs = 3;
template <class Real>
constexpr int tile_columns = tile_packs* width<Real>;
static_assert(front_tile<double> % tile_columns<double> == 0 &&
              front_tile<float> % tile_columns<float> == 0);
static_assert(front_tile<double> % tile_rows == 0 && front_tile<float> % tile_rows == 0);

/// Numbers in a tile of a panel.
template <class Real>
long tile_size(const FrontTask<Real>& t) {
  return static_cast<long>(t.pivots) * front_tile<Real>;
}

template <class Real>
Real* row_of(const FrontTask<Real>& t, int row) {
  return t.front + static_cast<long>(row) * t.stride;
}

template <class Real>
void fill_gaps(const FrontTask<Real>& t, Real* row) {
  for (int m = 0; m < t.moves; ++m) row[t.to[m]] = row[t.from[m]];
}

template <class Real>
void take_block(const FrontTask<Real>& t) {
  for (int k = 0; k < t.pivots; ++k) {
    const Real* const row = row_of(t, t.places[k]);
    for (int c = 0; c < t.pivots; ++c) t.block[k * t.pivots + c] = row[t.places[c]];
  }
}

/// Copies the pivots' rows, in the order in which they are eliminated.
template <class Real>
void take_upper(const FrontTask<Real>& t) {
  for (int k = 0; k < t.pivots; ++k) t.rows[k] = t.places[k];
  for (int k = 0; k < t.pivots; ++k) {
    const int swapped = t.rows[t.swapped[k]];
    t.rows[t.swapped[k]] = t.rows[k];
    t.rows[k] = swapped;
  }
  for (int k = 0; k < t.pivots; ++k) {
    Real* const row = row_of(t, t.rows[k]);
    fill_gaps(t, row);
    for (int c = t.rest; c % front_tile<Real> != 0; ++c) row[c] = 0;
    Real* to = t.upper + static_cast<long>(k) * front_tile<Real>;
    for (int c = 0; c < t.rest; c += front_tile<Real>, to += tile_size(t)) {
      for (int q = 0; q < front_tile<Real>; q += width<Real>) store(to + q, load(row + c + q));
    }
  }
}

/// Rows whose pivots are asked for before they are read.
constexpr int rows_ahead = 8;

/// Copies the pivots' columns and closes the gaps of the front.
template <class Real>
void take_lower(const FrontTask<Real>& t) {
  for (int m = 0; m < t.moves; ++m) {
    const Real* const from = row_of(t, t.from[m]);
    Real* const to = row_of(t, t.to[m]);
    for (int c = 0; c < t.rest + t.pivots; ++c) to[c] = from[c];
  }
  for (int first = 0; first < t.rest; first += front_tile<Real>) {
    Real* const tile = t.lower + first / front_tile<Real> * tile_size(t);
    for (int i = 0; i < front_tile<Real>; ++i) {
      if (first + i >= t.rest) {
        for (int k = 0; k < t.pivots; ++k) tile[k * front_tile<Real> + i] = 0;
        continue;
      }
      Real* const row = row_of(t, first + i);
      const Real* const ahead = row + rows_ahead * static_cast<long>(t.stride);
      for (int k = 0; k < t.pivots; ++k) {
        __builtin_prefetch(ahead + t.places[k], 1);
        tile[k * front_tile<Real> + i] = row[t.places[k]];
      }
      fill_gaps(t, row);
    }
  }
}

template <class Real>
void swap_rows(Real* a, Real* b, int count) {
  for (int i = 0; i < count; ++i) {
    const Real kept = a[i];
    a[i] = b[i];
    b[i] = kept;
  }
}

/// Factorises the block; returns the least pivot relative to its column, 0 for one that is none.
template <class Real>
double factorise(const FrontTask<Real>& t) {
  const int p = t.pivots;
  double least = 1;
  for (int k = 0; k < p; ++k) {
    Real size = 0;
    for (int i = 0; i < k; ++i)
      size = size > __builtin_fabs(t.block[i * p + k]) ? size : __builtin_fabs(t.block[i * p + k]);
    int best = k;
    Real largest = -1;
    for (int i = k; i < p; ++i) {
      const Real entry = __builtin_fabs(t.block[i * p + k]);
      if (entry > largest) {
        largest = entry;
        best = i;
      }
    }
    size = size > largest ? size : largest;
    const bool is_fine = largest > 0 && largest * 0 == 0;
    if (!is_fine) return 0;
    if (largest < least * size) least = largest / size;
    t.swapped[k] = best;
    if (best != k) swap_rows(t.block + k * p, t.block + best * p, p);
    const Real* const pivot_row = t.block + k * p;
    const Real inverse = 1 / pivot_row[k];
    for (int i = k + 1; i < p; ++i) {
      Real* const row = t.block + i * p;
      const Real factor = row[k] * inverse;
      row[k] = factor;
      for (int c = k + 1; c < p; ++c) row[c] -= factor * pivot_row[c];
    }
  }
  return least;
}

/// Coefficients of a triangular solve over vectors: v_j = (v_j - sum of at(i, j) v_i, i < j) / d_j.
template <class Real>
struct LowerUnit {  ///< rows of L^-1 A
  const Real* block;
  int p;
  Real at(int i, int j) const { return block[j * p + i]; }
  Real inverse(int) const { return 1; }
};
template <class Real>
struct UpperTurned {  ///< columns of B U^-1
  const Real* block;
  int p;
  Real at(int i, int j) const { return block[i * p + j]; }
  Real inverse(int j) const { return 1 / block[j * p + j]; }
};

/// Solves for `Rows` vectors from `first` on, some packs of columns, those before being done.
template <int Rows, class Real, class Triangle>
void solve_rows(const Triangle& triangle, int first, Real* vectors) {
  PackOf<Real> sums[Rows][tile_packs];
  for (int j = 0; j < Rows; ++j) {
    for (int q = 0; q < tile_packs; ++q)
      sums[j][q] = load(vectors + (first + j) * front_tile<Real> + q * width<Real>);
  }
  for (int i = 0; i < first; ++i) {
    PackOf<Real> known[tile_packs];
    for (int q = 0; q < tile_packs; ++q)
      known[q] = load(vectors + i * front_tile<Real> + q * width<Real>);
    for (int j = 0; j < Rows; ++j) {
      const PackOf<Real> factor = all(triangle.at(i, first + j));
      for (int q = 0; q < tile_packs; ++q) sums[j][q] = sums[j][q] - factor * known[q];
    }
  }
  for (int j = 0; j < Rows; ++j) {
    for (int i = 0; i < j; ++i) {
      const PackOf<Real> factor = all(triangle.at(first + i, first + j));
      for (int q = 0; q < tile_packs; ++q) sums[j][q] = sums[j][q] - factor * sums[i][q];
    }
    const PackOf<Real> inverse = all(triangle.inverse(first + j));
    for (int q = 0; q < tile_packs; ++q) {
      sums[j][q] = sums[j][q] * inverse;
      store(vectors + (first + j) * front_tile<Real> + q * width<Real>, sums[j][q]);
    }
  }
}

template <class Real, class Triangle>
void solve_panel(const FrontTask<Real>& t, const Triangle& triangle, Real* panel) {
  constexpr int rows = 4;
  for (int c = 0; c < t.rest; c += front_tile<Real>, panel += tile_size(t)) {
    for (int q = 0; q < front_tile<Real>; q += tile_columns<Real>) {
      int first = 0;
      for (; first + rows <= t.pivots; first += rows) solve_rows<rows>(triangle, first, panel + q);
      for (; first < t.pivots; ++first) solve_rows<1>(triangle, first, panel + q);
    }
  }
}

/// Some rows and packs of columns of the front lose the products of the panels.
template <class Real>
void subtract_products(int pivots, const Real* lower, const Real* upper, Real* corner,
                       long stride) {
  // The next rows are on their way while these are multiplied.
  for (int i = 0; i < tile_rows; ++i) {
    for (int q = 0; q < tile_packs; ++q)
      __builtin_prefetch(corner + (tile_rows + i) * stride + q * width<Real>, 1);
  }
  PackOf<Real> sums[tile_rows][tile_packs];
#pragma GCC unroll 8
  for (int i = 0; i < tile_rows; ++i) {
#pragma GCC unroll 3
    for (int q = 0; q < tile_packs; ++q) sums[i][q] = all(Real{0});
  }
  for (int k = 0; k < pivots; ++k, lower += front_tile<Real>, upper += front_tile<Real>) {
    PackOf<Real> row[tile_packs];
    for (int q = 0; q < tile_packs; ++q) row[q] = load(upper + q * width<Real>);
#pragma GCC unroll 8
    for (int i = 0; i < tile_rows; ++i) {
      const PackOf<Real> factor = all(lower[i]);
#pragma GCC unroll 3
      for (int q = 0; q < tile_packs; ++q) sums[i][q] = sums[i][q] + factor * row[q];
    }
  }
#pragma GCC unroll 8
  for (int i = 0; i < tile_rows; ++i) {
#pragma GCC unroll 3
    for (int q = 0; q < tile_packs; ++q) {
      Real* const at = corner + i * stride + q * width<Real>;
      store(at, load(at) - sums[i][q]);
    }
  }
}

template <class Real>
void subtract_panels(const FrontTask<Real>& t) {
  const Real* upper = t.upper;
  for (int c = 0; c < t.rest; c += front_tile<Real>, upper += tile_size(t)) {
    for (int q = 0; q < front_tile<Real>; q += tile_columns<Real>) {
      const Real* lower = t.lower;
      for (int r = 0; r < t.rest; r += front_tile<Real>, lower += tile_size(t)) {
        for (int i = 0; i < front_tile<Real>; i += tile_rows) {
          subtract_products(t.pivots, lower + i, upper + q, row_of(t, r + i) + c + q, t.stride);
        }
      }
    }
  }
}

template <class Real>
void eliminate(const FrontTask<Real>& task) {
  take_block(task);
  *task.least_pivot = factorise(task);
  const bool is_fine = *task.least_pivot > 0;
  if (!is_fine) return;
  take_upper(task);
  take_lower(task);
  solve_panel(task, LowerUnit<Real>{task.block, task.pivots}, task.upper);
  solve_panel(task, UpperTurned<Real>{task.block, task.pivots}, task.lower);
  subtract_panels(task);
}

}  // namespace

void eliminate_pivots(const FrontTask<double>& task) { eliminate(task); }
void eliminate_pivots(const FrontTask<float>& task) { eliminate(task); }

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
