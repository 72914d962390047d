#include "problems/core/block_factors.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// The columns of a row's factors: the matrix' own and, where it is filled, those that its blocks
/// reach through the rows above. `columns` is scratch.
template <int Size>
std::span<const int> pattern_of(const BlockMatrix<Size>& matrix, int row, bool is_filled,
                                std::vector<int>& columns) {
  const auto row_of = [&](int index) {
    return std::span<const int>(matrix.columns.data() + matrix.offsets[index],
                                matrix.columns.data() + matrix.offsets[index + 1]);
  };
  const std::span<const int> own = row_of(row);
  if (!is_filled) return own;
  columns.assign(own.begin(), own.end());
  for (const int above : own) {
    if (above >= row) break;
    const std::span<const int> reached = row_of(above);
    columns.insert(columns.end(), std::upper_bound(reached.begin(), reached.end(), above),
                   reached.end());
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  return columns;
}

/// One row of an incomplete factorisation in its pattern; `place` finds its blocks by
/// column and is -1 elsewhere.
template <int Size>
class PatternRow {
 public:
  using Factors = BlockFactors<Size>;
  using Block = typename Factors::Block;

  explicit PatternRow(int rows) : place_(rows, -1) {}

  /// Copies row `index` of the matrix.
  void start(const BlockMatrix<Size>& matrix, int index, bool is_filled) {
    const std::span<const int> pattern = pattern_of(matrix, index, is_filled, columns_);
    begin_ = pattern.data();
    count_ = static_cast<int>(pattern.size());
    for (int i = 0; i < count_; ++i) place_[begin_[i]] = i;
    const std::int64_t begin = matrix.offsets[index];
    const std::int64_t end = matrix.offsets[index + 1];
    const double* from = matrix.values.data() + begin * Factors::entries;
    if (!is_filled) {
      blocks_.assign(from, from + (end - begin) * Factors::entries);
      return;
    }
    blocks_.assign(static_cast<std::size_t>(count_) * Factors::entries, 0.0);
    for (std::int64_t i = begin; i < end; ++i, from += Factors::entries) {
      std::copy_n(from, Factors::entries,
                  blocks_.data() + place_[matrix.columns[i]] * Factors::entries);
    }
  }
  /// Subtracts multiples of the rows above.
  void eliminate(const Factors& factors, int index) {
    for (int i = 0; i < count_ && begin_[i] < index; ++i) {
      const int above = begin_[i];
      const Block factor = block(i).lazyProduct(factors.pivot(above));
      block(i) = factor;
      const SingleMatrix<Size>& upper = factors.upper;
      for (std::int64_t j = upper.offsets[above]; j < upper.offsets[above + 1]; ++j) {
        const int place = place_[upper.columns[j]];
        if (place >= 0) block(place) -= factor.lazyProduct(factors.above(j));
      }
    }
  }
  /// Appends the row to the factors and forgets it.
  void store(Factors& factors, int index) {
    double size = 0;
    for (int i = 0; i < count_; ++i) {
      place_[begin_[i]] = -1;
      size += block(i).norm() / count_;
      if (begin_[i] == index) continue;
      SingleMatrix<Size>& triangle = begin_[i] < index ? factors.lower : factors.upper;
      triangle.append(begin_[i], blocks_.data() + i * Factors::entries);
    }
    const int diagonal =
        static_cast<int>(std::lower_bound(begin_, begin_ + count_, index) - begin_);
    const bool is_there = diagonal < count_ && begin_[diagonal] == index;
    const Block pivot = is_there ? Block(block(diagonal)) : Block::Zero();
    factors.lower.end_row();
    factors.upper.end_row();
    constexpr double shift = 1e-2;  // of the mean block, as in the factorisation with threshold
    factors.append_pivot(pivot, shift * size);
  }

 private:
  const int* begin_ = nullptr;
  int count_ = 0;
  std::vector<int> place_, columns_;
  std::vector<double> blocks_;

  Eigen::Map<Block> block(int i) {
    return Eigen::Map<Block>(blocks_.data() + i * Factors::entries);
  }
};

}  // namespace

template <int Size>
bool invert_block(Eigen::Matrix<double, Size, Size> block, double least,
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

template <int Size, int Columns>
void SingleMatrix<Size, Columns>::reserve(int row_count, std::int64_t blocks) {
  offsets.reserve(row_count + 1);
  columns.reserve(blocks);
  values.reserve(blocks * Size * Columns + block_padding);
}

template <int Size, int Columns>
void SingleMatrix<Size, Columns>::append(int column, const double* block) {
  columns.push_back(column);
  for (int i = 0; i < Size * Columns; ++i) values.push_back(static_cast<float>(block[i]));
}

template <int Size>
void BlockFactors<Size>::append_pivot(const Block& pivot, double shift) {
  const int row = static_cast<int>(pivots.size()) / entries;
  // A pivot this far below the shift would blow up what follows; the shift is of the size dropped.
  constexpr double least_share = 1e-6;
  Block inverse;
  Block changed = pivot;
  if (!invert_block<Size>(changed, least_share * shift, inverse)) {
    ++shifted;
    do {
      if (!std::isfinite(shift) || !(shift > 0) || !pivot.allFinite()) {
        throw CaseError(fmt::format("the pivot of block row {} is not finite", row));
      }
      changed = pivot + shift * Block::Identity();
      shift *= 2;
    } while (!invert_block<Size>(changed, least_share * shift, inverse));
  }
  pivots.insert(pivots.end(), inverse.data(), inverse.data() + entries);
}

template <int Size>
void BlockFactors<Size>::finish() {
  lower.pad();
  upper.pad();
  single_pivots_.assign(pivots.begin(), pivots.end());
  single_pivots_.resize(single_pivots_.size() + block_padding, 0.F);
  std::vector<double>().swap(pivots);
}

template <int Size>
void BlockFactors<Size>::apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const {
  solve_unit_lower<Size>(lower.view(), rows(), r.data(), z.data());
  solve_upper<Size>(upper.view(), single_pivots_.data(), rows(), z.data());
}

template <int Size>
BlockFactors<Size> block_ilu0(const BlockMatrix<Size>& matrix, const std::vector<char>& filled) {
  const int rows = matrix.rows();
  const auto is_filled = [&](int row) { return !filled.empty() && filled[row] != 0; };
  BlockFactors<Size> factors;
  std::int64_t below = 0;
  std::int64_t all = 0;
  std::vector<int> scratch;
  for (int row = 0; row < rows; ++row) {
    const std::span<const int> pattern = pattern_of(matrix, row, is_filled(row), scratch);
    below += std::lower_bound(pattern.begin(), pattern.end(), row) - pattern.begin();
    all += static_cast<std::int64_t>(pattern.size());
  }
  factors.lower.reserve(rows, below);
  factors.upper.reserve(rows, all - below);
  factors.pivots.reserve(static_cast<std::size_t>(rows) * factors.entries);
  PatternRow<Size> row(rows);
  for (int index = 0; index < rows; ++index) {
    row.start(matrix, index, is_filled(index));
    row.eliminate(factors, index);
    row.store(factors, index);
  }
  factors.finish();
  return factors;
}

#define STRONGPOINT_INSTANTIATE(size) /* every block size that a solver takes */ \
  template bool invert_block(Eigen::Matrix<double, size, size>, double,          \
                             Eigen::Matrix<double, size, size>&);                \
  template struct SingleMatrix<size>;                                            \
  template class BlockFactors<size>;                                             \
  template BlockFactors<size> block_ilu0(const BlockMatrix<size>&, const std::vector<char>&);
STRONGPOINT_INSTANTIATE(1)
STRONGPOINT_INSTANTIATE(2)
STRONGPOINT_INSTANTIATE(3)
STRONGPOINT_INSTANTIATE(4)
#undef STRONGPOINT_INSTANTIATE
template struct SingleMatrix<2, 3>;

}  // namespace strongpoint
