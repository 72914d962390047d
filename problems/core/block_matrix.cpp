#include "problems/core/block_matrix.hpp"

#include <algorithm>

namespace strongpoint {
namespace {

/// Finds the block columns of one row after the other; one for each thread.
template <int Size>
class BlockPattern {
 public:
  BlockPattern(const LinearSystem& system, const std::vector<int>& position)
      : system_(system), position_(position), row_of_mark_(position.size(), -1) {}

  /// Collects the block columns of a node's rows in ascending order.
  const std::vector<int>& find(int node) {
    columns_.clear();
    for (std::int64_t i = begin(node); i < end(node); ++i) {
      const int column = position_[system_.columns[i] / Size];
      if (row_of_mark_[column] == node) continue;
      row_of_mark_[column] = node;
      columns_.push_back(column);
    }
    std::sort(columns_.begin(), columns_.end());
    return columns_;
  }

  std::int64_t begin(int node) const {
    return system_.offsets[static_cast<std::int64_t>(node) * Size];
  }
  std::int64_t end(int node) const {
    return system_.offsets[static_cast<std::int64_t>(node + 1) * Size];
  }

 private:
  const LinearSystem& system_;
  const std::vector<int>& position_;  ///< of each node in the order
  std::vector<int> row_of_mark_;      ///< (nodes) the node whose row last had this column
  std::vector<int> columns_;
};

/// Writes the entries of a node's rows into its blocks, which are zero before. `place` is scratch,
/// (nodes).
template <int Size>
void fill_row(const LinearSystem& system, const std::vector<int>& position, int node,
              const std::vector<int>& columns, std::vector<int>& place, double* blocks) {
  for (std::size_t i = 0; i < columns.size(); ++i) place[columns[i]] = static_cast<int>(i);
  for (int row = 0; row < Size; ++row) {
    const std::int64_t equation = static_cast<std::int64_t>(node) * Size + row;
    for (std::int64_t i = system.offsets[equation]; i < system.offsets[equation + 1]; ++i) {
      const std::int64_t unknown = system.columns[i];
      const auto block = static_cast<std::ptrdiff_t>(place[position[unknown / Size]]);
      blocks[block * Size * Size + unknown % Size * Size + row] = system.values[i];
    }
  }
}

}  // namespace

template <int Size>
BlockMatrix<Size> block_matrix(const LinearSystem& system, const std::vector<int>& order) {
  const int rows = static_cast<int>(order.size());
  std::vector<int> position(rows);
  for (int row = 0; row < rows; ++row) position[order[row]] = row;
  BlockMatrix<Size> matrix;
  matrix.offsets.assign(rows + 1, 0);
#pragma omp parallel
  {
    BlockPattern<Size> pattern(system, position);
#pragma omp for schedule(static)
    for (int row = 0; row < rows; ++row) {
      matrix.offsets[row + 1] = static_cast<std::int64_t>(pattern.find(order[row]).size());
    }
  }
  for (int row = 0; row < rows; ++row) matrix.offsets[row + 1] += matrix.offsets[row];
  matrix.columns.resize(matrix.offsets.back());
  matrix.values.resize(matrix.offsets.back() * matrix.entries + block_padding);
#pragma omp parallel
  {
    BlockPattern<Size> pattern(system, position);
    std::vector<int> place(rows);
#pragma omp for schedule(static)
    for (int row = 0; row < rows; ++row) {
      const std::vector<int>& columns = pattern.find(order[row]);
      std::copy(columns.begin(), columns.end(), matrix.columns.begin() + matrix.offsets[row]);
      fill_row<Size>(system, position, order[row], columns, place,
                     matrix.values.data() + matrix.offsets[row] * matrix.entries);
    }
  }
  return matrix;
}

template <int Size>
void BlockMatrix<Size>::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  constexpr int rows_a_task = 512;  // above, the threads share; waking them for less takes longer
  const int tasks = (rows() + rows_a_task - 1) / rows_a_task;
#pragma omp parallel for schedule(static) if (tasks > 1)
  for (int task = 0; task < tasks; ++task) {
    const int begin = task * rows_a_task;
    multiply_rows<Size>(offsets.data(), columns.data(), values.data(), begin,
                        std::min(rows(), begin + rows_a_task), x.data(), y.data());
  }
}

#define STRONGPOINT_INSTANTIATE(size) /* every block size that a solver takes */ \
  template struct BlockMatrix<size>;                                             \
  template BlockMatrix<size> block_matrix(const LinearSystem&, const std::vector<int>&);
STRONGPOINT_INSTANTIATE(1)
STRONGPOINT_INSTANTIATE(2)
STRONGPOINT_INSTANTIATE(3)
STRONGPOINT_INSTANTIATE(4)
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
