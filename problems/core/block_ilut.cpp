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

/// Inverts a block by Gauss-Jordan elimination with row pivoting; false when a pivot is at most
/// `least`.
template <int Size>
bool invert(Eigen::Matrix<double, Size, Size> block, double least,
            Eigen::Matrix<double, Size, Size>& inverse) {
  inverse.setIdentity();
  for (int k = 0; k < Size; ++k) {
    int best = k;
    for (int row = k + 1; row < Size; ++row) {
      if (std::abs(block(row, k)) > std::abs(block(best, k))) best = row;
    }
    if (!(std::abs(block(best, k)) > least)) return false;
    block.row(k).swap(block.row(best));
    inverse.row(k).swap(inverse.row(best));
    const double pivot = block(k, k);
    block.row(k) /= pivot;
    inverse.row(k) /= pivot;
    for (int row = 0; row < Size; ++row) {
      if (row == k) continue;
      const double factor = block(row, k);
      block.row(row) -= factor * block.row(k);
      inverse.row(row) -= factor * inverse.row(k);
    }
  }
  return true;
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
BlockIlut<Size>::BlockIlut(const BlockMatrix<Size>& matrix, const Parameters& parameters) {
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
    keep(row, row.lower, quota(parameters.fill, left, index), lower_);
    keep(row, row.upper, quota(parameters.fill, end - begin - left, rows - 1 - index), upper_);
    // Source of the shift: Saad's SPARSKIT, ilut.
    invert_pivot(row.block(diagonal), (1e-4 + parameters.drop) * mean);
  }
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
  const auto prepare = [rows](Triangle& triangle, std::int64_t blocks) {
    triangle.offsets.reserve(rows + 1);
    triangle.columns.reserve(blocks);
    triangle.values.reserve(blocks * entries);
  };
  prepare(lower_, lower);
  prepare(upper_, upper);
  pivots_.reserve(static_cast<std::size_t>(rows) * entries);
}

/// Subtracts multiples of the rows above; blocks of at most `least` are dropped on the way.
template <int Size>
void BlockIlut<Size>::eliminate(Row& row, int index, double least) {
  row.lower.clear();
  row.upper.clear();
  for (int k = row.next_lower(0); k < index; k = row.next_lower(k + 1)) {
    const int slot = row.slot(k);
    const Block factor = row.block(slot).lazyProduct(
        Eigen::Map<const Block>(pivots_.data() + static_cast<std::ptrdiff_t>(k) * entries));
    if (factor.norm() <= least) continue;
    row.block(slot) = factor;
    row.lower.push_back(slot);
    for (std::int64_t i = upper_.offsets[k]; i < upper_.offsets[k + 1]; ++i) {
      const Eigen::Map<const Eigen::Matrix<float, Size, Size>> above(upper_.values.data() +
                                                                     i * entries);
      row.block(row.slot(upper_.columns[i])) -= factor.lazyProduct(above.template cast<double>());
    }
  }
  for (int slot = 0; slot < static_cast<int>(row.columns.size()); ++slot) {
    if (row.columns[slot] > index && row.size(slot) > least) row.upper.push_back(slot);
  }
}

/// Appends the `most` largest of the chosen slots to a triangle, equal ones by column.
template <int Size>
void BlockIlut<Size>::keep(const Row& row, std::vector<int>& chosen, std::int64_t most,
                           Triangle& triangle) {
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
    triangle.columns.push_back(row.columns[slot]);
    const double* block = row.blocks.data() + static_cast<std::ptrdiff_t>(slot) * entries;
    for (int i = 0; i < entries; ++i) triangle.values.push_back(static_cast<float>(block[i]));
  }
  triangle.offsets.push_back(static_cast<std::int64_t>(triangle.columns.size()));
}

/// Appends an inverted pivot block, shifted when it is singular.
template <int Size>
void BlockIlut<Size>::invert_pivot(const Block& pivot, double shift) {
  const int row = static_cast<int>(pivots_.size()) / entries;
  // A pivot this far below the shift would blow up what follows; the shift is of the size dropped.
  constexpr double least_share = 1e-6;
  Block inverse;
  Block shifted = pivot;
  if (!invert<Size>(shifted, least_share * shift, inverse)) {
    ++shifted_;
    do {
      if (!std::isfinite(shift)) {
        throw CaseError(fmt::format("the pivot of block row {} is not finite", row));
      }
      shifted = pivot + shift * Block::Identity();
      shift *= 2;
    } while (!invert<Size>(shifted, least_share * shift, inverse));
  }
  pivots_.insert(pivots_.end(), inverse.data(), inverse.data() + entries);
}

template <int Size>
void BlockIlut<Size>::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  using Part = Eigen::Matrix<double, Size, 1>;
  const auto subtract = [&z](const Triangle& triangle, int row, Part& sum) {
    for (std::int64_t i = triangle.offsets[row]; i < triangle.offsets[row + 1]; ++i) {
      const Eigen::Map<const Eigen::Matrix<float, Size, Size>> block(triangle.values.data() +
                                                                     i * entries);
      const auto column = static_cast<Eigen::Index>(triangle.columns[i]) * Size;
      sum -= block.template cast<double>().lazyProduct(z.segment<Size>(column));
    }
  };
  const int rows = static_cast<int>(lower_.offsets.size()) - 1;
  for (int row = 0; row < rows; ++row) {
    Part sum = r.segment<Size>(static_cast<Eigen::Index>(row) * Size);
    subtract(lower_, row, sum);
    z.segment<Size>(static_cast<Eigen::Index>(row) * Size) = sum;
  }
  for (int row = rows - 1; row >= 0; --row) {
    Part sum = z.segment<Size>(static_cast<Eigen::Index>(row) * Size);
    subtract(upper_, row, sum);
    const Eigen::Map<const Block> pivot(pivots_.data() +
                                        static_cast<std::ptrdiff_t>(row) * entries);
    z.segment<Size>(static_cast<Eigen::Index>(row) * Size) = pivot.lazyProduct(sum);
  }
}

template class BlockIlut<1>;
template class BlockIlut<2>;
template class BlockIlut<3>;
template class BlockIlut<4>;

}  // namespace strongpoint
