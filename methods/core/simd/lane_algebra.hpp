#pragma once

#include "methods/core/simd/pack.hpp"

// For kernel sources only: small dense matrices, one in each lane, worked on side by side. The work
// is done by one product that keeps a tile of its result in registers; triangular solves and
// factorisations are arranged around it, four columns at a time.

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// A matrix of packs inside a larger array, by its strides.
struct LaneMatrix {
  Pack* first;
  long row;     ///< packs from an entry to the one below
  long column;  ///< and to the one on its right

  Pack& operator()(int i, int j) const { return first[i * row + j * column]; }
  LaneMatrix block(int i, int j) const { return {&(*this)(i, j), row, column}; }
  LaneMatrix transposed() const { return {first, column, row}; }
};

/// Hands out parts of an array, one after the other.
class LaneRoom {
 public:
  /// `scratch` begins at a cache line.
  explicit LaneRoom(double* scratch) : next_(reinterpret_cast<Pack*>(scratch)) {}

  Pack* packs(long count) {
    Pack* const taken = next_;
    next_ += count;
    return taken;
  }
  /// (rows, columns), row after row.
  LaneMatrix matrix(long rows, long columns) { return {packs(rows * columns), columns, 1}; }

 private:
  Pack* next_;
};

/// Rows and columns of the largest tile whose sums, with a column and an entry of the factors, fit
/// the registers: 32 of them on AVX-512, 16 elsewhere.
inline constexpr int tile_rows = lanes == 8 ? 4 : 3;
inline constexpr int tile_columns = lanes == 8 ? 5 : 4;
/// Columns that solves and factorisations treat at a time.
inline constexpr int panel = 4;

/// c (Rows, Columns) -= a (Rows, depth) b (depth, Columns).
template <int Rows, int Columns>
void subtract_tile(const LaneMatrix& c, const LaneMatrix& a, const LaneMatrix& b, int depth) {
  Pack sum[Rows][Columns];
#pragma GCC unroll 8
  for (int i = 0; i < Rows; ++i) {
#pragma GCC unroll 8
    for (int j = 0; j < Columns; ++j) sum[i][j] = c(i, j);
  }
  const Pack* left = a.first;
  const Pack* right = b.first;
  for (int k = 0; k < depth; ++k, left += a.column, right += b.row) {
    Pack factors[Rows];
#pragma GCC unroll 8
    for (int i = 0; i < Rows; ++i) factors[i] = left[i * a.row];
#pragma GCC unroll 8
    for (int j = 0; j < Columns; ++j) {
      const Pack factor = right[j * b.column];
#pragma GCC unroll 8
      for (int i = 0; i < Rows; ++i) sum[i][j] = sum[i][j] - factors[i] * factor;
    }
  }
#pragma GCC unroll 8
  for (int i = 0; i < Rows; ++i) {
#pragma GCC unroll 8
    for (int j = 0; j < Columns; ++j) c(i, j) = sum[i][j];
  }
}

/// The same with sizes that are known when the program runs, up to a tile's.
template <int Rows, int Columns>
void subtract_small(int rows, int columns, const LaneMatrix& c, const LaneMatrix& a,
                    const LaneMatrix& b, int depth) {
  if constexpr (Rows > 1) {
    if (rows < Rows) return subtract_small<Rows - 1, Columns>(rows, columns, c, a, b, depth);
  }
  if constexpr (Columns > 1) {
    if (columns < Columns) return subtract_small<Rows, Columns - 1>(rows, columns, c, a, b, depth);
  }
  subtract_tile<Rows, Columns>(c, a, b, depth);
}

/// c (rows, columns) -= a (rows, depth) b (depth, columns), in tiles of about equal sizes.
inline void subtract_product(int rows, int columns, const LaneMatrix& c, const LaneMatrix& a,
                             const LaneMatrix& b, int depth) {
  const int down = (rows + tile_rows - 1) / tile_rows;
  const int across = (columns + tile_columns - 1) / tile_columns;
  for (int q = 0; depth > 0 && q < across; ++q) {
    const int j = columns * q / across;
    const int width = columns * (q + 1) / across - j;
    for (int p = 0; p < down; ++p) {
      const int i = rows * p / down;
      const int height = rows * (p + 1) / down - i;
      subtract_small<tile_rows, tile_columns>(height, width, c.block(i, j), a.block(i, 0),
                                              b.block(0, j), depth);
    }
  }
}

/// The same for the lower triangle of c (size, size), with some entries above the diagonal, which
/// are not meaningful then.
inline void subtract_product_below(int size, const LaneMatrix& c, const LaneMatrix& a,
                                   const LaneMatrix& b, int depth) {
  for (int i = 0; i < size; i += tile_rows) {
    const int height = size - i < tile_rows ? size - i : tile_rows;
    subtract_product(height, i + height, c.block(i, 0), a.block(i, 0), b, depth);
  }
}

/// Solves the triangle (Size, Size) for all columns; rows are counted from its first one, or from
/// its last one where the strides are negative: the latter serves upper triangles.
template <int Size>
void solve_triangle(const LaneMatrix& triangle, const Pack* inverse, int step, int columns,
                    const LaneMatrix& x) {
  for (int c = 0; c < columns; ++c) {
    Pack values[Size];
#pragma GCC unroll 8
    for (int i = 0; i < Size; ++i) {
      values[i] = x(i, c);
#pragma GCC unroll 8
      for (int k = 0; k < i; ++k) values[i] = values[i] - triangle(i, k) * values[k];
      if (inverse != nullptr) values[i] = values[i] * inverse[i * step];
      x(i, c) = values[i];
    }
  }
}

/// The same with a size that is known when the program runs, up to a panel's.
template <int Size = panel>
void solve_small(int size, const LaneMatrix& triangle, const Pack* inverse, int step, int columns,
                 const LaneMatrix& x) {
  if constexpr (Size > 1) {
    if (size < Size) return solve_small<Size - 1>(size, triangle, inverse, step, columns, x);
  }
  solve_triangle<Size>(triangle, inverse, step, columns, x);
}

/// Solves L y = x, x (size, columns) becoming y. `inverse` (size) are those of the diagonal, or
/// null: the diagonal is one.
inline void solve_lower(int size, const LaneMatrix& lower, const Pack* inverse, int columns,
                        const LaneMatrix& x) {
  for (int begin = 0; begin < size; begin += panel) {
    const int width = size - begin < panel ? size - begin : panel;
    subtract_product(width, columns, x.block(begin, 0), lower.block(begin, 0), x, begin);
    solve_small(width, lower.block(begin, begin), inverse == nullptr ? nullptr : inverse + begin, 1,
                columns, x.block(begin, 0));
  }
}

/// Solves U y = x likewise.
inline void solve_upper(int size, const LaneMatrix& upper, const Pack* inverse, int columns,
                        const LaneMatrix& x) {
  for (int end = size; end > 0; end = (end - 1) / panel * panel) {
    const int begin = (end - 1) / panel * panel;
    subtract_product(end - begin, columns, x.block(begin, 0), upper.block(begin, end),
                     x.block(end, 0), size - end);
    const LaneMatrix turned{&upper(end - 1, end - 1), -upper.row, -upper.column};
    solve_small(end - begin, turned, inverse == nullptr ? nullptr : inverse + end - 1, -1, columns,
                {&x(end - 1, 0), -x.row, x.column});
  }
}

/// Factorises A = L U, U = D L^T, of symmetric definite matrices (size, size) in place, without
/// exchanges; the lower triangle is read, L is unit lower. `inverse` (size) becomes that of D.
/// Gives the bits of the lanes where every pivot has the sign of the first and is above `tolerance`
/// times its diagonal entry.
inline unsigned factorise_definite(int size, const LaneMatrix& a, Pack* inverse, double tolerance) {
  unsigned good = every_lane;
  for (int i = 0; i < size; ++i) {
    inverse[i] = all(tolerance) * abs(a(i, i));
    for (int j = i + 1; j < size && j < i + panel; ++j) a(i, j) = all(0);
  }
  const Pack first = size > 0 ? a(0, 0) : all(1);
  for (int begin = 0; begin < size; begin += panel) {
    const int end = begin + panel < size ? begin + panel : size;
    subtract_product(size - begin, end - begin, a.block(begin, begin), a.block(begin, 0),
                     a.block(0, begin), begin);
    for (int j = begin; j < end; ++j) {
      const Pack pivot = a(j, j);
      good &= less(inverse[j], abs(pivot)) & less(all(0), pivot * first);
      inverse[j] = all(1) / pivot;
      const Pack reciprocal = inverse[j];
      for (int i = j + 1; i < size; ++i) {
        a(j, i) = a(i, j);
        a(i, j) = a(i, j) * reciprocal;
      }
      for (int k = j + 1; k < end; ++k) {
        const Pack factor = a(j, k);
        for (int i = k; i < size; ++i) a(i, k) = a(i, k) - a(i, j) * factor;
      }
    }
  }
  return good;
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
