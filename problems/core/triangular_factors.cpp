#include "problems/core/triangular_factors.hpp"

#include <cstring>
#include <new>

#include <umfpack.h>

namespace strongpoint {
namespace {

using Indices = std::vector<std::int64_t>;

SuiteSparse_long* as_long(Indices& indices) {
  static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));
  return reinterpret_cast<SuiteSparse_long*>(indices.data());
}

/// A triangle in compressed rows or columns.
struct Compressed {
  Indices offsets, indices;
  std::vector<double> values;

  Compressed(std::int64_t n, std::int64_t entries)
      : offsets(n + 1), indices(entries), values(entries) {}
};

/// The same entries by the other index, ascending within each.
Compressed transposed(const Compressed& from) {
  const auto n = static_cast<std::int64_t>(from.offsets.size()) - 1;
  Compressed to(n, static_cast<std::int64_t>(from.indices.size()));
  for (const std::int64_t index : from.indices) ++to.offsets[index + 1];
  for (std::int64_t i = 0; i < n; ++i) to.offsets[i + 1] += to.offsets[i];
  Indices next(to.offsets.begin(), to.offsets.end() - 1);
  for (std::int64_t major = 0; major < n; ++major) {
    for (std::int64_t e = from.offsets[major]; e < from.offsets[major + 1]; ++e) {
      const std::int64_t place = next[from.indices[e]]++;
      to.indices[place] = major;
      to.values[place] = from.values[e];
    }
  }
  return to;
}

/// Two numbers side by side.
using Two = double __attribute__((vector_size(16)));

/// From anywhere in memory.
Two load(const double* from) {
  Two numbers;
  std::memcpy(&numbers, from, sizeof(Two));
  return numbers;
}

}  // namespace

TriangleRows::TriangleRows(const Indices& offsets, const Indices& columns,
                           const std::vector<double>& values) {
  const auto rows = static_cast<std::int64_t>(offsets.size()) - 1;
  row_runs_.reserve(rows + 1);
  values_.reserve(values.size());
  for (std::int64_t row = 0; row < rows; ++row) {
    const std::size_t first = runs_.size();
    for (std::int64_t e = offsets[row]; e < offsets[row + 1]; ++e) {
      const auto column = static_cast<int>(columns[e]);
      if (column == row) continue;
      if (runs_.size() == first || runs_.back().column + runs_.back().length != column) {
        runs_.push_back({column, 0, static_cast<std::int64_t>(values_.size())});
      }
      ++runs_.back().length;
      values_.push_back(values[e]);
    }
    row_runs_.push_back(static_cast<int>(runs_.size()));
  }
}

double TriangleRows::times(int row, const double* x) const {
  Two sums[2] = {Two{}, Two{}};
  double rest = 0;
  for (int r = row_runs_[row]; r < row_runs_[row + 1]; ++r) {
    const Run& run = runs_[r];
    const double* a = values_.data() + run.values;
    const double* b = x + run.column;
    int i = 0;
    for (; i + 4 <= run.length; i += 4) {
      sums[0] += load(a + i) * load(b + i);
      sums[1] += load(a + i + 2) * load(b + i + 2);
    }
    for (; i < run.length; ++i) rest += a[i] * b[i];
  }
  const Two sum = sums[0] + sums[1];
  return sum[0] + sum[1] + rest;
}

TriangularFactors::TriangularFactors(void* numeric) {
  SuiteSparse_long lower_entries = 0;
  SuiteSparse_long upper_entries = 0;
  SuiteSparse_long rows = 0;
  SuiteSparse_long columns = 0;
  SuiteSparse_long diagonal = 0;
  umfpack_dl_get_lunz(&lower_entries, &upper_entries, &rows, &columns, &diagonal, numeric);
  Compressed lower(rows, lower_entries);  // by rows
  Compressed upper(rows, upper_entries);  // by columns
  Indices row_order(rows);
  Indices column_order(rows);
  SuiteSparse_long multiplies = 0;
  inverse_pivots_.resize(rows);
  scales_.resize(rows);
  const SuiteSparse_long status = umfpack_dl_get_numeric(
      as_long(lower.offsets), as_long(lower.indices), lower.values.data(), as_long(upper.offsets),
      as_long(upper.indices), upper.values.data(), as_long(row_order), as_long(column_order),
      inverse_pivots_.data(), &multiplies, scales_.data(), numeric);
  if (status != UMFPACK_OK) throw std::bad_alloc();
  for (double& pivot : inverse_pivots_) pivot = 1 / pivot;
  if (multiplies == 0) {
    for (double& scale : scales_) scale = 1 / scale;
  }
  row_order_.assign(row_order.begin(), row_order.end());
  column_order_.assign(column_order.begin(), column_order.end());
  part_.resize(rows);
  // Both by ascending indices: columns of U are rows of U^T, and L is turned round.
  const Compressed sorted = transposed(transposed(upper));
  triangles_.emplace_back(sorted.offsets, sorted.indices, sorted.values);
  const Compressed turned = transposed(lower);
  triangles_.emplace_back(turned.offsets, turned.indices, turned.values);
}

/// U^T L^T (P R^-1 x) = Q^T b.
void TriangularFactors::solve(const double* b, double* x) const {
  const auto n = static_cast<int>(row_order_.size());
  double* part = part_.data();
  for (int i = 0; i < n; ++i) {
    part[i] = (b[column_order_[i]] - triangles_[0].times(i, part)) * inverse_pivots_[i];
  }
  for (int i = n - 1; i >= 0; --i) part[i] -= triangles_[1].times(i, part);
  for (int i = 0; i < n; ++i) x[row_order_[i]] = part[i] * scales_[row_order_[i]];
}

std::size_t TriangularFactors::bytes() const {
  return triangles_[0].bytes() + triangles_[1].bytes() +
         row_order_.size() * (2 * sizeof(int) + 3 * sizeof(double));
}

}  // namespace strongpoint
