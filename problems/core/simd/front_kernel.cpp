#include "problems/core/simd/front_kernel.hpp"

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// A tile of the front in registers: as many rows, and packs of columns.
constexpr int tile_rows = lanes == 8 ? 8 : 4;
constexpr int tile_packs = 3;
constexpr int tile_columns = tile_packs * lanes;
constexpr int front_packs = front_tile / lanes;
constexpr int pivots_summed = 32;
static_assert(front_tile % tile_columns == 0 && front_tile % tile_rows == 0);

/// Numbers in a tile of a panel.
long tile_size(const FrontTask& t) { return static_cast<long>(t.pivots) * front_tile; }

double* row_of(const FrontTask& t, int row) { return t.front + static_cast<long>(row) * t.stride; }

void fill_gaps(const FrontTask& t, double* row) {
  for (int m = 0; m < t.moves; ++m) row[t.to[m]] = row[t.from[m]];
}

void take_block(const FrontTask& t) {
  for (int k = 0; k < t.pivots; ++k) {
    const double* const row = row_of(t, t.places[k]);
    for (int c = 0; c < t.pivots; ++c) t.block[k * t.pivots + c] = row[t.places[c]];
  }
}

/// Copies the pivots' rows, in the order in which they are eliminated.
void take_upper(const FrontTask& t) {
  for (int k = 0; k < t.pivots; ++k) t.rows[k] = t.places[k];
  for (int k = 0; k < t.pivots; ++k) {
    const int swapped = t.rows[t.swapped[k]];
    t.rows[t.swapped[k]] = t.rows[k];
    t.rows[k] = swapped;
  }
  for (int k = 0; k < t.pivots; ++k) {
    double* const row = row_of(t, t.rows[k]);
    fill_gaps(t, row);
    for (int c = t.rest; c % front_tile != 0; ++c) row[c] = 0;
    double* to = t.upper + static_cast<long>(k) * front_tile;
    for (int c = 0; c < t.rest; c += front_tile, to += tile_size(t)) {
      for (int q = 0; q < front_tile; q += lanes) store(to + q, load(row + c + q));
    }
  }
}

/// Rows whose pivots are asked for before they are read.
constexpr int rows_ahead = 8;

/// Copies the pivots' columns and closes the gaps of the front.
void take_lower(const FrontTask& t) {
  for (int m = 0; m < t.moves; ++m) {
    const double* const from = row_of(t, t.from[m]);
    double* const to = row_of(t, t.to[m]);
    for (int c = 0; c < t.rest + t.pivots; ++c) to[c] = from[c];
  }
  for (int first = 0; first < t.rest; first += front_tile) {
    double* const tile = t.lower + first / front_tile * tile_size(t);
    for (int i = 0; i < front_tile; ++i) {
      if (first + i >= t.rest) {
        for (int k = 0; k < t.pivots; ++k) tile[k * front_tile + i] = 0;
        continue;
      }
      double* const row = row_of(t, first + i);
      const double* const ahead = row + rows_ahead * static_cast<long>(t.stride);
      for (int k = 0; k < t.pivots; ++k) {
        __builtin_prefetch(ahead + t.places[k], 1);
        tile[k * front_tile + i] = row[t.places[k]];
      }
      fill_gaps(t, row);
    }
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

/// Solves for `Rows` vectors from `first` on, some packs of columns, those before being done.
template <int Rows, class Triangle>
void solve_rows(const Triangle& triangle, int first, double* vectors) {
  Pack sums[Rows][tile_packs];
  for (int j = 0; j < Rows; ++j) {
    for (int q = 0; q < tile_packs; ++q)
      sums[j][q] = load(vectors + (first + j) * front_tile + q * lanes);
  }
  for (int i = 0; i < first; ++i) {
    Pack known[tile_packs];
    for (int q = 0; q < tile_packs; ++q) known[q] = load(vectors + i * front_tile + q * lanes);
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
      store(vectors + (first + j) * front_tile + q * lanes, sums[j][q]);
    }
  }
}

template <class Triangle>
void solve_panel(const FrontTask& t, const Triangle& triangle, double* panel) {
  constexpr int rows = 4;
  for (int c = 0; c < t.rest; c += front_tile, panel += tile_size(t)) {
    for (int q = 0; q < front_tile; q += tile_columns) {
      int first = 0;
      for (; first + rows <= t.pivots; first += rows) solve_rows<rows>(triangle, first, panel + q);
      for (; first < t.pivots; ++first) solve_rows<1>(triangle, first, panel + q);
    }
  }
}

/// Some rows and packs of columns of the front lose the products of the panels.
void subtract_products(int pivots, const double* lower, const double* upper, double* corner,
                       long stride) {
  // The next rows are on their way while these are multiplied.
  for (int i = 0; i < tile_rows; ++i) {
    for (int q = 0; q < tile_packs; ++q)
      __builtin_prefetch(corner + (tile_rows + i) * stride + q * lanes, 1);
  }
  Pack sums[tile_rows][tile_packs];
#pragma GCC unroll 8
  for (int i = 0; i < tile_rows; ++i) {
#pragma GCC unroll 3
    for (int q = 0; q < tile_packs; ++q) sums[i][q] = all(0);
  }
  for (int k = 0; k < pivots; ++k, lower += front_tile, upper += front_tile) {
    Pack row[tile_packs];
    for (int q = 0; q < tile_packs; ++q) row[q] = load(upper + q * lanes);
#pragma GCC unroll 8
    for (int i = 0; i < tile_rows; ++i) {
      const Pack factor = all(lower[i]);
#pragma GCC unroll 3
      for (int q = 0; q < tile_packs; ++q) sums[i][q] = sums[i][q] + factor * row[q];
    }
  }
#pragma GCC unroll 8
  for (int i = 0; i < tile_rows; ++i) {
#pragma GCC unroll 3
    for (int q = 0; q < tile_packs; ++q) {
      double* const at = corner + i * stride + q * lanes;
      store(at, load(at) - sums[i][q]);
    }
  }
}

void subtract_panels(const FrontTask& t) {
  const double* upper = t.upper;
  for (int c = 0; c < t.rest; c += front_tile, upper += tile_size(t)) {
    for (int q = 0; q < front_tile; q += tile_columns) {
      const double* lower = t.lower;
      for (int r = 0; r < t.rest; r += front_tile, lower += tile_size(t)) {
        for (int i = 0; i < front_tile; i += tile_rows) {
          subtract_products(t.pivots, lower + i, upper + q, row_of(t, r + i) + c + q, t.stride);
        }
      }
    }
  }
}

}  // namespace

void eliminate_pivots(const FrontTask& task) {
  take_block(task);
  *task.least_pivot = factorise(task);
  const bool is_fine = *task.least_pivot > 0;
  if (!is_fine) return;
  take_upper(task);
  take_lower(task);
  solve_panel(task, LowerUnit{task.block, task.pivots}, task.upper);
  solve_panel(task, UpperTurned{task.block, task.pivots}, task.lower);
  subtract_panels(task);
}

void multiply_panel(const PanelTask& t) {
  const double* panel = t.panel;
  for (int r = 0; r < t.rest; r += front_tile) {
    Pack sums[front_packs];
    for (int q = 0; q < front_packs; ++q) sums[q] = all(0);
    for (int k = 0; k < t.pivots; ++k, panel += front_tile) {
      fetch_ahead(panel);
      const Pack value = all(t.values[k]);
      for (int q = 0; q < front_packs; ++q) sums[q] = sums[q] + value * load(panel + q * lanes);
    }
    for (int q = 0; q < front_packs; ++q) store(t.beside + r + q * lanes, sums[q]);
  }
}

void subtract_turned_panel(const PanelTask& t) {
  for (int first = 0; first < t.pivots; first += pivots_summed) {
    const int count = t.pivots - first < pivots_summed ? t.pivots - first : pivots_summed;
    Pack sums[pivots_summed];
    for (int k = 0; k < count; ++k) sums[k] = all(0);
    const double* panel = t.panel + static_cast<long>(first) * front_tile;
    for (int r = 0; r < t.rest; r += front_tile) {
      Pack known[front_packs];
      for (int q = 0; q < front_packs; ++q) known[q] = load(t.beside + r + q * lanes);
      for (int k = 0; k < count; ++k) {
        for (int q = 0; q < front_packs; ++q) {
          sums[k] = sums[k] + known[q] * load(panel + k * front_tile + q * lanes);
        }
      }
      panel += static_cast<long>(t.pivots) * front_tile;
    }
    for (int k = 0; k < count; ++k) {
      double parts[lanes];
      store(parts, sums[k]);
      for (int lane = 0; lane < lanes; ++lane) t.values[first + k] -= parts[lane];
    }
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
