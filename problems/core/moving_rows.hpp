#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

#include "problems/core/block_matrix.hpp"
#include "problems/core/sparse_factor.hpp"

namespace strongpoint {

/// The rows of the unknowns that move, [A_II, A_IB], for products that are taken many times: A_II
/// in blocks of a node's fields, with one index a block; of A_IB the rows that are not empty.
class MovingRows {
 public:
  /// Takes the rows, (moving, moving + rest), and the number of fields of each node that moves: 1
  /// where nodes move in part.
  MovingRows(const RowMatrix& rows, int fields);

  /// product = A_II u + A_IB rest; the same bits on any number of threads.
  void multiply(const Eigen::VectorXd& u, const Eigen::VectorXd& rest,
                Eigen::VectorXd& product) const;
  /// factor [A_II, A_IB] as a sparse matrix without zeros.
  RowMatrix scaled(double factor) const;

 private:
  std::variant<BlockMatrix<1>, BlockMatrix<2>, BlockMatrix<3>> inner_;
  Eigen::Index moving_;
  Eigen::Index rest_;
  std::vector<int> outer_rows_;     ///< rows of A_IB with entries, ascending
  std::vector<int> outer_offsets_;  ///< (outer rows + 1) into the following
  std::vector<int> outer_columns_;
  std::vector<double> outer_values_;
};

}  // namespace strongpoint
