#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "problems/core/block_kernels.hpp"
#include "problems/core/solvers.hpp"

namespace strongpoint {

/// A square sparse matrix of dense blocks (Size, Size) in compressed rows; columns ascend within a
/// row and each block is stored by columns.
template <int Size>
struct BlockMatrix {
  static constexpr int entries = Size * Size;  ///< of one block

  std::vector<std::int64_t> offsets{0};  ///< (rows + 1) into `columns`
  std::vector<int> columns;              ///< (blocks)
  std::vector<double> values;            ///< (blocks * entries + block_padding)

  int rows() const { return static_cast<int>(offsets.size()) - 1; }
  std::size_t bytes() const {
    return offsets.size() * sizeof(std::int64_t) + columns.size() * sizeof(int) +
           values.size() * sizeof(double);
  }
  /// y = A x; the same bits on any number of threads.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
};

/// The blocks of a square system of `Size` fields: block row r holds the equations of node
/// `order[r]`, and block column r its unknowns. `order` lists every node once.
template <int Size>
BlockMatrix<Size> block_matrix(const LinearSystem& system, const std::vector<int>& order);

}  // namespace strongpoint
