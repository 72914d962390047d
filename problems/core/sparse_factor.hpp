#pragma once

#include <memory>
#include <string>

#include <Eigen/SparseCore>

namespace strongpoint {

/// A sparse matrix in compressed rows with 64-bit indices.
using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t>;

/// LU factors of a square sparse matrix, made once, for many right-hand sides: UMFPACK with full
/// partial pivoting. Source: Davis 2004, UMFPACK.
class SparseFactor {
 public:
  /// What can be wrong with a matrix.
  enum class Fault { none, singular, out_of_memory, other };

  /// How unknowns are ordered: as UMFPACK does by default, or in the way of all it knows that fills
  /// the factors least, for factors that solve many times.
  enum class Ordering { usual, least_fill };

  /// Factorises a matrix in compressed rows, which must live as long as the factors.
  explicit SparseFactor(const Eigen::Map<const RowMatrix>& matrix,
                        Ordering ordering = Ordering::usual);
  SparseFactor(const SparseFactor&) = delete;
  SparseFactor& operator=(const SparseFactor&) = delete;
  ~SparseFactor();

  Fault fault() const { return fault_; }
  /// UMFPACK's own word for the fault.
  int status() const { return status_; }
  /// UMFPACK's estimate of the reciprocal condition, the smallest over the largest pivot of the
  /// rows as it scales them.
  double pivot_ratio() const { return pivot_ratio_; }
  /// Steps of iterative refinement after a solve: none, or as many as UMFPACK takes by default,
  /// which suits who solves once.
  enum class Refinement { none, usual };
  /// Solves A x = b, n numbers each, without allocating. Throws std::logic_error for factors with a
  /// fault. Not to be called from several threads.
  void solve(const double* b, double* x, Refinement refinement) const;

 private:
  struct Objects;
  Eigen::Map<const RowMatrix> matrix_;
  std::unique_ptr<Objects> objects_;
  Fault fault_ = Fault::none;
  int status_ = 0;
  double pivot_ratio_ = 0;
};

}  // namespace strongpoint
