#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "problems/core/block_matrix.hpp"

namespace strongpoint {

/// Incomplete LU factorisation with dual threshold of a matrix of dense blocks: L has unit diagonal
/// blocks, those of U are stored inverted. Source: Saad 1994, ILUT, and Saad 2003, algorithm 10.6,
/// with blocks for numbers and Frobenius norms for magnitudes. Deviations: a row keeps a multiple
/// of its own number of blocks, not a fixed number; a singular pivot block is shifted and counted.
/// The factors are kept in single precision, which is far below what is dropped, at half the memory
/// and traffic; rows are eliminated in double.
template <int Size>
class BlockIlut {
 public:
  /// What is dropped.
  struct Parameters {
    double drop = 1e-2;  ///< blocks smaller than this times the mean block of the matrix row
    double fill = 2;     ///< blocks kept on either side of the diagonal, as a multiple of the row's
  };

  /// Factorises a matrix; both triangles are allocated once, as large as `fill` allows. Throws
  /// CaseError for a row of zeros and for factors that are not finite, naming the block row.
  BlockIlut(const BlockMatrix<Size>& matrix, const Parameters& parameters);

  /// z = U^-1 L^-1 r; r and z may not be the same.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

  /// Pivot blocks that were singular and have been shifted.
  int shifted_pivots() const { return shifted_; }
  /// Blocks kept in both triangles, without the diagonal.
  std::int64_t blocks() const {
    return static_cast<std::int64_t>(lower_.columns.size() + upper_.columns.size());
  }

 private:
  static constexpr int entries = Size * Size;
  using Block = Eigen::Matrix<double, Size, Size>;

  /// One strict triangle in compressed rows.
  struct Triangle {
    std::vector<std::int64_t> offsets{0};
    std::vector<int> columns;
    std::vector<float> values;
  };
  class Row;

  Triangle lower_, upper_;
  std::vector<double> pivots_;  ///< (rows * entries) inverted diagonal blocks of U
  int shifted_ = 0;

  void reserve(const BlockMatrix<Size>& matrix, double fill);
  void eliminate(Row& row, int index, double least);
  void keep(const Row& row, std::vector<int>& chosen, std::int64_t most, Triangle& triangle);
  void invert_pivot(const Block& pivot, double shift);
};

}  // namespace strongpoint
