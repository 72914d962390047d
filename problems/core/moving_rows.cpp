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
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  std::visit(
      [&]<int Size>(const BlockMatrix<Size>& blocks) {
        for (int row = 0; row < blocks.rows(); ++row) {
          for (std::int64_t b = blocks.offsets[row]; b < blocks.offsets[row + 1]; ++b) {
            for (int e = 0; e < blocks.entries; ++e) {
              const double value = blocks.values[b * blocks.entries + e];
              if (value == 0) continue;
              entries.emplace_back(row * Size + e % Size, blocks.columns[b] * Size + e / Size,
                                   factor * value);
            }
          }
        }
      },
      inner_);
  for (std::size_t i = 0; i < outer_rows_.size(); ++i) {
    for (int e = outer_offsets_[i]; e < outer_offsets_[i + 1]; ++e) {
      entries.emplace_back(outer_rows_[i], moving_ + outer_columns_[e], factor * outer_values_[e]);
    }
  }
  RowMatrix matrix(moving_, moving_ + rest_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace strongpoint
