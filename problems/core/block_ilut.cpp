#include "problems/core/block_ilut.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// Blocks kept of a row that has `count` on one side of the diagonal, where `room` would fit.
std::int64_t quota(double fill, std::int64_t count, std::int64_t room) {
  return static_cast<std::int64_t>(
      std::min(std::ceil(fill * static_cast<double>(count)), static_cast<double>(room)));
}

}  // namespace

/// A sparse row being eliminated: blocks in the order of their arrival, found by column, and the
/// columns of the lower triangle as set bits, which yields them in ascending order while more come.
template <int Size>
class BlockIlut<Size>::Row {
 public:
  explicit Row(int rows) : slots_(rows, -1), bits_(rows / 64 + 1, 0) {}

  /// Empties the row and gives it another diagonal place.
  void start(int diagonal) {
    for (const int column : columns) {
      slots_[column] = -1;
      bits_[column / 64] = 0;
    }
    columns.clear();
    blocks.clear();
    diagonal_ = diagonal;
  }
  /// The slot of a column; a new one holds zeros.
  int slot(int column) {
    int& slot = slots_[column];
    if (slot < 0) {
      slot = static_cast<int>(columns.size());
      columns.push_back(column);
      blocks.resize(blocks.size() + entries, 0.0);
      if (column < diagonal_) bits_[column / 64] |= std::uint64_t{1} << (column % 64);
    }
    return slot;
  }
  /// The first column from `column` on that is present, or the diagonal's.
  int next_lower(int column) const {
    if (column >= diagonal_) return diagonal_;
    std::size_t word = column / 64;
    std::uint64_t bits = bits_[word] & (~std::uint64_t{0} << (column % 64));
    const std::size_t last = diagonal_ / 64;
    while (bits == 0 && word < last) bits = bits_[++word];
    return bits == 0 ? diagonal_ : static_cast<int>(word * 64) + std::countr_zero(bits);
  }
  Eigen::Map<Block> block(int slot) { return Eigen::Map<Block>(blocks.data() + slot * entries); }
  double size(int slot) const {
    return Eigen::Map<const Block>(blocks.data() + slot * entries).norm();
  }

  std::vector<int> columns;    ///< (slots)
  std::vector<double> blocks;  ///< (slots * entries)
  std::vector<int> lower;      ///< slots below the diagonal that are not dropped
  std::vector<int> upper;      ///< slots above

 private:
  int diagonal_ = 0;
  std::vector<int> slots_;           ///< (rows) of each column, or -1
  std::vector<std::uint64_t> bits_;  ///< of columns below the diagonal
};

template <int Size>
BlockIlut<Size>::BlockIlut(const BlockMatrix<Size>& matrix, const Parameters& parameters)
    : Preconditioner(static_cast<Eigen::Index>(matrix.rows()) * Size) {
  const int rows = matrix.rows();
  reserve(matrix, parameters.fill);
  Row row(rows);
  for (int index = 0; index < rows; ++index) {
    row.start(index);
    const int diagonal = row.slot(index);
    const std::int64_t begin = matrix.offsets[index];
    const std::int64_t end = matrix.offsets[index + 1];
    double mean = 0;
    std::int64_t left = 0;
    for (std::int64_t i = begin; i < end; ++i) {
      const Eigen::Map<const Block> block(matrix.values.data() + i * entries);
      row.block(row.slot(matrix.columns[i])) = block;
      mean += block.norm() / static_cast<double>(end - begin);
      if (matrix.columns[i] < index) ++left;
    }
    if (!(mean > 0)) {
      throw CaseError(fmt::format("block row {} of the system holds zeros alone", index));
    }
    eliminate(row, index, parameters.drop * mean);
    keep(row, row.lower, quota(parameters.fill, left, index), factors_.lower);
    keep(row, row.upper, quota(parameters.fill, end - begin - left, rows - 1 - index),
         factors_.upper);
    // Source of the shift: Saad's SPARSKIT, ilut.
    factors_.append_pivot(row.block(diagonal), (1e-4 + parameters.drop) * mean);
  }
  factors_.finish();
}

template <int Size>
void BlockIlut<Size>::reserve(const BlockMatrix<Size>& matrix, double fill) {
  const int rows = matrix.rows();
  std::int64_t lower = 0;
  std::int64_t upper = 0;
  for (int row = 0; row < rows; ++row) {
    const auto begin = matrix.columns.begin() + matrix.offsets[row];
    const auto end = matrix.columns.begin() + matrix.offsets[row + 1];
    const std::int64_t left = std::lower_bound(begin, end, row) - begin;
    lower += quota(fill, left, row);
    upper += quota(fill, end - begin - left, rows - 1 - row);
  }
  factors_.lower.reserve(rows, lower);
  factors_.upper.reserve(rows, upper);
  factors_.pivots.reserve(static_cast<std::size_t>(rows) * entries);
}

/// Subtracts multiples of the rows above; blocks of at most `least` are dropped on the way.
template <int Size>
void BlockIlut<Size>::eliminate(Row& row, int index, double least) {
  row.lower.clear();
  row.upper.clear();
  for (int k = row.next_lower(0); k < index; k = row.next_lower(k + 1)) {
    const int slot = row.slot(k);
    const Block factor = row.block(slot).lazyProduct(factors_.pivot(k));
    if (factor.norm() <= least) continue;
    row.block(slot) = factor;
    row.lower.push_back(slot);
    const SingleMatrix<Size>& above = factors_.upper;
    for (std::int64_t i = above.offsets[k]; i < above.offsets[k + 1]; ++i) {
      row.block(row.slot(above.columns[i])) -= factor.lazyProduct(factors_.above(i));
    }
  }
  for (int slot = 0; slot < static_cast<int>(row.columns.size()); ++slot) {
    if (row.columns[slot] > index && row.size(slot) > least) row.upper.push_back(slot);
  }
}

/// Appends the `most` largest of the chosen slots to a triangle, equal ones by column.
template <int Size>
void BlockIlut<Size>::keep(const Row& row, std::vector<int>& chosen, std::int64_t most,
                           SingleMatrix<Size>& triangle) {
  if (static_cast<std::int64_t>(chosen.size()) > most) {
    std::nth_element(chosen.begin(), chosen.begin() + most, chosen.end(), [&](int a, int b) {
      const double size_a = row.size(a);
      const double size_b = row.size(b);
      return size_a > size_b || (size_a == size_b && row.columns[a] < row.columns[b]);
    });
    chosen.resize(most);
  }
  std::sort(chosen.begin(), chosen.end(),
            [&](int a, int b) { return row.columns[a] < row.columns[b]; });
  for (const int slot : chosen) {
    triangle.append(row.columns[slot],
                    row.blocks.data() + static_cast<std::ptrdiff_t>(slot) * entries);
  }
  triangle.end_row();
}

template class BlockIlut<1>;
template class BlockIlut<2>;
template class BlockIlut<3>;
template class BlockIlut<4>;

}  // namespace strongpoint
