#include "problems/core/moving_rows.hpp"

#include <numeric>

namespace strongpoint {
namespace {

template <int Size>
BlockMatrix<Size> blocks_of(const LinearSystem& system) {
  std::vector<int> order(system.rows() / Size);
  std::iota(order.begin(), order.end(), 0);
  return block_matrix<Size>(system, order);
}

/// Adds one row of blocks, times a factor and without zeros, to the last row of a matrix.
template <int Size>
void append_row(const BlockMatrix<Size>& blocks, Eigen::Index row, double factor,
                RowMatrix& matrix) {
  for (std::int64_t b = blocks.offsets[row / Size]; b < blocks.offsets[row / Size + 1]; ++b) {
    for (int column = 0; column < Size; ++column) {
      const double value = blocks.values[(b * Size + column) * Size + row % Size];
      if (value == 0) continue;
      matrix.insertBack(row, static_cast<Eigen::Index>(blocks.columns[b]) * Size + column) =
          factor * value;
    }
  }
}

}  // namespace

MovingRows::MovingRows(const RowMatrix& rows, int fields)
    : moving_(rows.rows()), rest_(rows.cols() - rows.rows()), outer_offsets_{0} {
  LinearSystem inner;
  for (Eigen::Index row = 0; row < moving_; ++row) {
    for (RowMatrix::InnerIterator entry(rows, row); entry; ++entry) {
      if (entry.col() < moving_) {
        inner.columns.push_back(entry.col());
        inner.values.push_back(entry.value());
      } else {
        outer_columns_.push_back(static_cast<int>(entry.col() - moving_));
        outer_values_.push_back(entry.value());
      }
    }
    inner.offsets.push_back(static_cast<std::int64_t>(inner.columns.size()));
    const auto end = static_cast<int>(outer_columns_.size());
    if (end == outer_offsets_.back()) continue;
    outer_rows_.push_back(static_cast<int>(row));
    outer_offsets_.push_back(end);
  }
  if (fields == 2) {
    inner_ = blocks_of<2>(inner);
  } else if (fields == 3) {
    inner_ = blocks_of<3>(inner);
  } else {
    inner_ = blocks_of<1>(inner);
  }
}

void MovingRows::multiply(const Eigen::VectorXd& u, const Eigen::VectorXd& rest,
                          Eigen::VectorXd& product) const {
  std::visit([&](const auto& blocks) { blocks.multiply(u, product); }, inner_);
  for (std::size_t i = 0; i < outer_rows_.size(); ++i) {
    double sum = 0;
    for (int e = outer_offsets_[i]; e < outer_offsets_[i + 1]; ++e) {
      sum += outer_values_[e] * rest[outer_columns_[e]];
    }
    product[outer_rows_[i]] += sum;
  }
}

RowMatrix MovingRows::scaled(double factor) const {
  RowMatrix matrix(moving_, moving_ + rest_);
  std::visit(
      [&](const auto& blocks) {
        matrix.reserve(static_cast<Eigen::Index>(blocks.values.size() + outer_values_.size()));
      },
      inner_);
  std::size_t outer = 0;
  for (Eigen::Index row = 0; row < moving_; ++row) {
    matrix.startVec(row);
    std::visit([&](const auto& blocks) { append_row(blocks, row, factor, matrix); }, inner_);
    if (outer == outer_rows_.size() || outer_rows_[outer] != row) continue;
    for (int e = outer_offsets_[outer]; e < outer_offsets_[outer + 1]; ++e) {
      matrix.insertBack(row, moving_ + outer_columns_[e]) = factor * outer_values_[e];
    }
    ++outer;
  }
  matrix.finalize();
  return matrix;
}

}  // namespace strongpoint
