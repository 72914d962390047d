#pragma once

#include <cstdint>
#include <vector>

namespace strongpoint {

/// The rows of a strict triangle for many solves: entries of consecutive columns in runs, which
/// nested dissection makes long, with one start for a run in place of an index for every entry.
class TriangleRows {
 public:
  /// Takes a triangle in compressed rows whose columns ascend within a row; entries of the diagonal
  /// are left out.
  TriangleRows(const std::vector<std::int64_t>& offsets, const std::vector<std::int64_t>& columns,
               const std::vector<double>& values);

  /// The product of a row with x.
  double times(int row, const double* x) const;
  std::size_t bytes() const {
    return runs_.size() * sizeof(Run) + row_runs_.size() * sizeof(int) +
           values_.size() * sizeof(double);
  }

 private:
  struct Run {
    int column, length;
    std::int64_t values;  ///< place of the first
  };
  std::vector<int> row_runs_{0};  ///< (rows + 1) into `runs_`
  std::vector<Run> runs_;
  std::vector<double> values_;
};

/// LU factors as UMFPACK gives them, P R A^T Q = L U, packed for many solves of A x = b. Source:
/// Davis 2004.
class TriangularFactors {
 public:
  /// Copies the factors out of UMFPACK's object. Throws std::bad_alloc.
  explicit TriangularFactors(void* numeric);

  /// x = A^-1 b, n numbers each; x and b may not be the same. Not to be called from several
  /// threads.
  void solve(const double* b, double* x) const;
  std::size_t bytes() const;

 private:
  std::vector<TriangleRows> triangles_;        ///< U^T and L^T
  std::vector<double> inverse_pivots_;         ///< (n) of U
  std::vector<double> scales_;                 ///< (n) R
  std::vector<int> row_order_, column_order_;  ///< (n) P and Q
  mutable std::vector<double> part_;
};

}  // namespace strongpoint
