#pragma once

#include <memory>
#include <string>

#include <Eigen/SparseCore>

#include "problems/core/triangular_factors.hpp"

namespace strongpoint {

/// A sparse matrix in compressed rows with 64-bit indices.
using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t>;

/// LU factors of a square sparse matrix, made once, for many right-hand sides, by UMFPACK. Source:
/// Davis 2004, UMFPACK.
class SparseFactor {
 public:
  /// What can be wrong with a matrix.
  enum class Fault { none, singular, out_of_memory, other };

  /// How unknowns are ordered and pivots chosen.
  enum class Ordering {
    usual,       ///< UMFPACK's default, full partial pivoting where it finds no symmetric pattern
    least_fill,  ///< that of all it knows with the least fill, for factors that solve many times
    nodes        ///< nested dissection of the nodes, pivots on the diagonal but for tiny ones: the
                 ///< caller has to judge the residual
  };

  /// Factorises a matrix in compressed rows, which must live as long as the factors. `fields`
  /// unknowns in turn belong to a node, for `Ordering::nodes`.
  explicit SparseFactor(const Eigen::Map<const RowMatrix>& matrix,
                        Ordering ordering = Ordering::usual, int fields = 1);
  SparseFactor(const SparseFactor&) = delete;
  SparseFactor& operator=(const SparseFactor&) = delete;
  ~SparseFactor();

  Fault fault() const { return fault_; }
  /// UMFPACK's own word for the fault.
  int status() const { return status_; }
  /// UMFPACK's estimate of the reciprocal condition, the smallest over the largest pivot of the
  /// rows as it scales them.
  double pivot_ratio() const { return pivot_ratio_; }
  /// Memory of the factors.
  std::size_t bytes() const { return bytes_; }
  /// Most memory that the factorisation took, factors included.
  std::size_t peak_bytes() const { return peak_bytes_; }
  /// Solves A x = b, n numbers each, with iterative refinement, without allocating. Throws
  /// std::logic_error for factors with a fault. Not to be called from several threads.
  void solve(const double* b, double* x) const;
  /// The factors for many solves without refinement, which outlive this object. Throws
  /// std::logic_error for factors with a fault.
  TriangularFactors packed() const;

 private:
  struct Objects;
  Eigen::Map<const RowMatrix> matrix_;
  std::unique_ptr<Objects> objects_;
  Fault fault_ = Fault::none;
  int status_ = 0;
  double pivot_ratio_ = 0;
  std::size_t bytes_ = 0;
  std::size_t peak_bytes_ = 0;
};

}  // namespace strongpoint
