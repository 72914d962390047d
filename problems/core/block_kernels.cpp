#include "problems/core/block_kernels.hpp"

namespace strongpoint {
namespace {

/// Four numbers side by side. The last lanes of a block of three columns hold what follows it and
/// are never stored.
using Four = float __attribute__((vector_size(16)));
using Two = double __attribute__((vector_size(16)));

/// Numbers from anywhere in memory: a copy, as not all compilers let a vector be read through a
/// pointer with less than its alignment.
template <class Vector, class Real>
Vector copied(const Real* from) {
  Vector vector;
  __builtin_memcpy(&vector, from, sizeof(Vector));
  return vector;
}
Four load(const float* from) { return copied<Four>(from); }
Four spread(float x) { return Four{x, x, x, x}; }
Two load(const double* from) { return copied<Two>(from); }
Two spread(double x) { return Two{x, x}; }

/// The sum of blocks times parts of x for one block row; two sums by turns hide the latency.
template <int Size, int Columns = Size>
class Sum {
 public:
  void add(const float* block, const float* x, int turn) {
    if constexpr (Size == 2) {
      lanes_[turn] += load(block) * Four{x[0], x[0], x[1], x[1]};
      if constexpr (Columns == 3) lanes_[turn] += load(block + 4) * Four{x[2], x[2], 0, 0};
    } else {
      for (int j = 0; j < Size; ++j) lanes_[turn] += load(block + j * Size) * spread(x[j]);
    }
  }
  float operator[](int i) const {
    const Four lanes = lanes_[0] + lanes_[1];
    return Size == 2 ? lanes[i] + lanes[i + 2] : lanes[i];
  }

 private:
  Four lanes_[2] = {Four{}, Four{}};
};

template <>
class Sum<1, 1> {
 public:
  void add(const float* block, const float* x, int turn) { sums_[turn] += block[0] * x[0]; }
  float operator[](int) const { return sums_[0] + sums_[1]; }

 private:
  float sums_[2] = {0, 0};
};

/// The same in double precision.
template <int Size>
class DoubleSum {
 public:
  void add(const double* block, const double* x, int turn) {
    for (int j = 0; j < Size; ++j) {
      for (int pair = 0; pair < pairs; ++pair) {
        sums_[turn][pair] += load(block + j * Size + 2 * pair) * spread(x[j]);
      }
    }
  }
  double operator[](int i) const { return sums_[0][i / 2][i % 2] + sums_[1][i / 2][i % 2]; }

 private:
  static constexpr int pairs = (Size + 1) / 2;
  Two sums_[2][pairs] = {};
};

template <>
class DoubleSum<1> {
 public:
  void add(const double* block, const double* x, int turn) { sums_[turn] += block[0] * x[0]; }
  double operator[](int) const { return sums_[0] + sums_[1]; }

 private:
  double sums_[2] = {0, 0};
};

/// The product of the blocks [begin, end) of one row with x.
template <int Size, int Columns, class RowSum, class Real>
RowSum blocks_times(std::int64_t begin, std::int64_t end, const int* columns, const Real* values,
                    const Real* x) {
  RowSum sum;
  const auto add = [&](std::int64_t i, int turn) {
    sum.add(values + i * Size * Columns, x + static_cast<std::int64_t>(columns[i]) * Columns, turn);
  };
  std::int64_t i = begin;
  for (; i + 1 < end; i += 2) {
    add(i, 0);
    add(i + 1, 1);
  }
  if (i < end) add(i, 0);
  return sum;
}

template <int Size, int Columns = Size>
Sum<Size, Columns> row_times(const SingleBlocks& a, int row, const float* x) {
  return blocks_times<Size, Columns, Sum<Size, Columns>>(a.offsets[row], a.offsets[row + 1],
                                                         a.columns, a.values, x);
}

}  // namespace

template <int Size>
void solve_unit_lower(const SingleBlocks& lower, int rows, const float* r, float* z) {
  for (int row = 0; row < rows; ++row) {
    const Sum<Size> sum = row_times<Size>(lower, row, z);
    const std::int64_t first = static_cast<std::int64_t>(row) * Size;
    for (int i = 0; i < Size; ++i) z[first + i] = r[first + i] - sum[i];
  }
}

template <int Size>
void solve_upper(const SingleBlocks& upper, const float* inverses, int rows, float* z) {
  for (int row = rows - 1; row >= 0; --row) {
    const Sum<Size> sum = row_times<Size>(upper, row, z);
    const std::int64_t first = static_cast<std::int64_t>(row) * Size;
    float part[Size];
    for (int i = 0; i < Size; ++i) part[i] = z[first + i] - sum[i];
    Sum<Size> solved;
    solved.add(inverses + first * Size, part, 0);
    for (int i = 0; i < Size; ++i) z[first + i] = solved[i];
  }
}

template <int Size, int Columns>
void subtract_product(const SingleBlocks& a, int rows, const float* x, float* r) {
  for (int row = 0; row < rows; ++row) {
    const Sum<Size, Columns> sum = row_times<Size, Columns>(a, row, x);
    const std::int64_t first = static_cast<std::int64_t>(row) * Size;
    for (int i = 0; i < Size; ++i) r[first + i] -= sum[i];
  }
}

template <int Size>
void multiply_rows(const std::int64_t* offsets, const int* columns, const double* values, int begin,
                   int end, const double* x, double* y) {
  for (int row = begin; row < end; ++row) {
    const auto sum = blocks_times<Size, Size, DoubleSum<Size>>(offsets[row], offsets[row + 1],
                                                               columns, values, x);
    for (int i = 0; i < Size; ++i) y[static_cast<std::int64_t>(row) * Size + i] = sum[i];
  }
}

#define STRONGPOINT_INSTANTIATE(size) /* every block size that a solver takes */              \
  template void solve_unit_lower<size>(const SingleBlocks&, int, const float*, float*);       \
  template void solve_upper<size>(const SingleBlocks&, const float*, int, float*);            \
  template void subtract_product<size>(const SingleBlocks&, int, const float*, float*);       \
  template void multiply_rows<size>(const std::int64_t*, const int*, const double*, int, int, \
                                    const double*, double*);
STRONGPOINT_INSTANTIATE(1)
STRONGPOINT_INSTANTIATE(2)
STRONGPOINT_INSTANTIATE(3)
STRONGPOINT_INSTANTIATE(4)
#undef STRONGPOINT_INSTANTIATE
template void subtract_product<2, 3>(const SingleBlocks&, int, const float*, float*);

}  // namespace strongpoint
