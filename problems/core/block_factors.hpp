#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "problems/core/block_kernels.hpp"
#include "problems/core/block_matrix.hpp"

namespace strongpoint {

/// Inverts a block by Gauss-Jordan elimination with row pivoting; false when a pivot is at most
/// `least`.
template <int Size>
bool invert_block(Eigen::Matrix<double, Size, Size> block, double least,
                  Eigen::Matrix<double, Size, Size>& inverse);

/// A sparse matrix of dense blocks (Size, Columns) in compressed rows, in single precision and
/// stored by columns.
template <int Size, int Columns = Size>
struct SingleMatrix {
  std::vector<std::int64_t> offsets{0};  ///< (rows + 1)
  std::vector<int> columns;              ///< (blocks)
  std::vector<float> values;  ///< (blocks * Size * Columns), padded once `pad` was called

  int rows() const { return static_cast<int>(offsets.size()) - 1; }
  /// Makes room for `row_count` rows of `blocks` in all.
  void reserve(int row_count, std::int64_t blocks);
  /// Appends a block in double precision to the row under way.
  void append(int column, const double* block);
  void end_row() { offsets.push_back(static_cast<std::int64_t>(columns.size())); }
  /// Appends what the kernels may read; no row may follow.
  void pad() { values.resize(values.size() + block_padding, 0.F); }
  SingleBlocks view() const { return {offsets.data(), columns.data(), values.data()}; }
  std::size_t bytes() const {
    return offsets.size() * sizeof(std::int64_t) + columns.size() * sizeof(int) +
           values.size() * sizeof(float);
  }
};

/// Incomplete triangular factors of a matrix of dense blocks, built row by row: L has unit diagonal
/// blocks, those of U are inverted. They are kept in single precision, which is far below what is
/// dropped, at half the memory and traffic.
template <int Size>
class BlockFactors {
 public:
  static constexpr int entries = Size * Size;  ///< of one block
  using Block = Eigen::Matrix<double, Size, Size>;

  SingleMatrix<Size> lower, upper;  ///< strict triangles
  std::vector<double> pivots;       ///< (rows * entries) inverses, until `finish`
  int shifted = 0;                  ///< pivot blocks that were singular and have been shifted

  int rows() const { return lower.rows(); }
  Eigen::Map<const Block> pivot(int row) const {
    return Eigen::Map<const Block>(pivots.data() + static_cast<std::ptrdiff_t>(row) * entries);
  }
  /// Block `place` of the upper triangle.
  Block above(std::int64_t place) const {
    using SingleBlock = Eigen::Matrix<float, Size, Size>;
    return Eigen::Map<const SingleBlock>(upper.values.data() + place * entries)
        .template cast<double>();
  }
  /// Appends an inverted pivot block; a singular one is shifted and counted. Throws CaseError for
  /// one that is not finite, naming the block row.
  void append_pivot(const Block& pivot, double shift);
  /// Ends the building.
  void finish();
  /// z = U^-1 L^-1 r of finished factors; r and z may be the same.
  void apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const;
  /// Memory of finished factors.
  std::size_t bytes() const {
    return lower.bytes() + upper.bytes() + single_pivots_.size() * sizeof(float);
  }

 private:
  std::vector<float> single_pivots_;  ///< (rows * entries + block_padding)
};

/// Incomplete LU factorisation in the pattern of the matrix. Source: Saad 2003, algorithm 10.4,
/// with blocks for numbers. Deviations: singular pivots are shifted; rows marked in `filled`,
/// (rows) or none, are given the first level of fill. Rows of tractions need it: no diagonal
/// dominates them, and what ILU(0) drops along a side lets the substitution grow from node to node.
/// Throws CaseError as `BlockFactors::append_pivot` does.
template <int Size>
BlockFactors<Size> block_ilu0(const BlockMatrix<Size>& matrix,
                              const std::vector<char>& filled = {});

}  // namespace strongpoint
