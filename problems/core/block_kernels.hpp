#pragma once

#include <cstdint>

namespace strongpoint {

/// A sparse matrix of dense blocks (Size, Columns), square ones unless said otherwise, in single
/// precision, in compressed rows, each block stored by columns. A view.
struct SingleBlocks {
  const std::int64_t* offsets;  ///< (rows + 1)
  const int* columns;           ///< (blocks)
  const float* values;          ///< (blocks * Size * Columns + block_padding)
};

/// Numbers that the kernels may read past the last block.
inline constexpr int block_padding = 2;

/// z = L^-1 r of `rows` block rows, L the strict lower triangle and a unit diagonal; r may be z.
template <int Size>
void solve_unit_lower(const SingleBlocks& lower, int rows, const float* r, float* z);

/// z = U^-1 z, U the strict upper triangle and the inverses of its diagonal blocks, (rows * Size *
/// Size + block_padding).
template <int Size>
void solve_upper(const SingleBlocks& upper, const float* inverses, int rows, float* z);

/// r -= A x of `rows` block rows; blocks may be (2, 3).
template <int Size, int Columns = Size>
void subtract_product(const SingleBlocks& a, int rows, const float* x, float* r);

/// y = A x of block rows [begin, end) in double precision; `values` as in `SingleBlocks`.
template <int Size>
void multiply_rows(const std::int64_t* offsets, const int* columns, const double* values, int begin,
                   int end, const double* x, double* y);

}  // namespace strongpoint
