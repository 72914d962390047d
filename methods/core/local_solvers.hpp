#pragma once

#include <span>
#include <vector>

namespace strongpoint {

/// What is left of a column of a local system, relative to the column, when it is singular: the
/// nodes lie on the zero set of a polynomial, or the projections cannot tell the terms apart. About
/// five digits of the weights are left above it.
inline constexpr double rank_tolerance = 1e-11;

/// Householder QR of a tall dense matrix whose storage is reused from one stencil to the next.
class HouseholderQr {
 public:
  /// Storage for a (rows, cols) matrix, column after column, rows >= cols, to be filled by the
  /// caller.
  double* prepare(int rows, int cols);
  /// Factorises in place. False when some column lies within `tolerance`, relative to its own
  /// length, of the span of the columns before it.
  bool factorise(double tolerance);
  /// Solves R^T y = g, g (cols) becoming y.
  void solve_transposed_r(std::span<double> g) const;
  /// v (rows) becomes Q v.
  void apply_q(std::span<double> v) const;
  /// v (rows) becomes Q^T v.
  void apply_q_transposed(std::span<double> v) const;

 private:
  int rows_ = 0, cols_ = 0;
  std::vector<double> a_;         ///< reflectors below the diagonal, R above it
  std::vector<double> diagonal_;  ///< diagonal of R
  std::vector<double> beta_;      ///< 2 / |v|^2 of each reflector

  void reflect(int k, double* v) const;
};

/// LDL^T of a small symmetric matrix without pivoting, for definite matrices, with reused storage.
class Ldlt {
 public:
  /// Storage for an (n, n) matrix, of which the lower triangle (row after row) is read.
  double* prepare(int n);
  /// Factorises in place. False when some pivot is below `tolerance` times its diagonal entry, or a
  /// pivot's sign differs from the first one's.
  bool factorise(double tolerance);
  /// Solves A x = b, b (n) becoming x.
  void solve(std::span<double> b) const;

 private:
  int n_ = 0;
  std::vector<double> a_;
};

/// LU of a small square matrix with row exchanges and reused storage; rows are judged relative to
/// their largest entries. Exact zeros stay zeros: a triangular or block triangular matrix is solved
/// without fill.
class Lu {
 public:
  /// Storage for an (n, n) matrix, row after row, to be filled by the caller.
  double* prepare(int n);
  /// Factorises in place. False when what is left of some column is below `tolerance` times the
  /// largest entry that the column had, both relative to their rows.
  bool factorise(double tolerance);
  /// Solves A x = b, b (n) becoming x.
  void solve(std::span<double> b) const;
  /// Solves A^T x = b, b (n) becoming x.
  void solve_transposed(std::span<double> b) const;

 private:
  int n_ = 0;
  std::vector<double> a_;        ///< U, and the multipliers of L below its diagonal
  std::vector<double> largest_;  ///< of each column, before the elimination and relative to rows
  std::vector<double> scale_;    ///< 1 / largest entry of each row, before the elimination
  std::vector<int> exchanged_;   ///< row exchanged with row k at step k

  double& at(int i, int j) { return a_[static_cast<std::size_t>(i) * n_ + j]; }
  double at(int i, int j) const { return a_[static_cast<std::size_t>(i) * n_ + j]; }
};

}  // namespace strongpoint
