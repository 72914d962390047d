#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "problems/core/block_factors.hpp"
#include "problems/core/preconditioner.hpp"

namespace strongpoint {

/// Incomplete LU factorisation with dual threshold of a matrix of dense blocks: L has unit diagonal
/// blocks, those of U are stored inverted. Source: Saad 1994, ILUT, and Saad 2003, algorithm 10.6,
/// with blocks for numbers and Frobenius norms for magnitudes. Deviations: a row keeps a multiple
/// of its own number of blocks, not a fixed number; a singular pivot block is shifted and counted.
/// Rows are eliminated in double precision.
template <int Size>
class BlockIlut : public Preconditioner {
 public:
  /// What is dropped.
  struct Parameters {
    double drop = 1e-2;  ///< blocks smaller than this times the mean block of the matrix row
    double fill = 2;     ///< blocks kept on either side of the diagonal, as a multiple of the row's
  };

  /// Factorises a matrix; both triangles are allocated once, as large as `fill` allows. Throws
  /// CaseError for a row of zeros and for factors that are not finite, naming the block row.
  BlockIlut(const BlockMatrix<Size>& matrix, const Parameters& parameters);

  using Preconditioner::apply;
  void apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const override { factors_.apply(r, z); }
  int shifted_pivots() const override { return factors_.shifted; }
  std::size_t bytes() const override { return factors_.bytes(); }
  /// Blocks kept in both triangles, without the diagonal.
  std::int64_t blocks() const {
    return static_cast<std::int64_t>(factors_.lower.columns.size() + factors_.upper.columns.size());
  }

 private:
  static constexpr int entries = Size * Size;
  using Block = Eigen::Matrix<double, Size, Size>;

  class Row;

  BlockFactors<Size> factors_;

  void reserve(const BlockMatrix<Size>& matrix, double fill);
  void eliminate(Row& row, int index, double least);
  void keep(const Row& row, std::vector<int>& chosen, std::int64_t most,
            SingleMatrix<Size>& triangle);
};

}  // namespace strongpoint
