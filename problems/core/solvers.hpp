#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "methods/core/options.hpp"

namespace strongpoint {

/// A square sparse system in compressed rows; columns ascend within a row.
struct LinearSystem {
  std::vector<std::int64_t> offsets{0};  ///< (rows + 1)
  std::vector<std::int64_t> columns;     ///< (entries)
  std::vector<double> values;            ///< (entries)
  Eigen::VectorXd right_hand_side;       ///< (rows)
  int fields = 1;                        ///< unknown = node * fields + field
  std::int64_t width = 0;                ///< number of unknowns; 0: as many as rows

  std::int64_t rows() const { return static_cast<std::int64_t>(offsets.size()) - 1; }
  std::int64_t unknowns() const { return width > 0 ? width : rows(); }
};

/// A solution of a linear system.
struct LinearSolution {
  Eigen::VectorXd x;
  double residual = 0;  ///< |b - A x| / (|A| |x| + |b|), maximum norm
};

/// Rows whose residual is above this have not been solved.
inline constexpr double largest_residual = 1e-8;

/// Names, summaries and options of all solvers.
const std::vector<EntryInfo>& solvers();

/// Canonical form of a `--solver` spec. Throws UsageError when it is malformed or unknown.
std::string canonical_solver(std::string_view spec);

/// Solves a system whose rows are scaled to a largest entry of 1. Throws CaseError when the matrix
/// is singular, the solution is not finite or the residual exceeds `largest_residual`.
LinearSolution solve(const LinearSystem& system, std::string_view solver);

}  // namespace strongpoint
