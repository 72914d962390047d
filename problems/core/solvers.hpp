#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "methods/core/large_array.hpp"
#include "methods/core/options.hpp"

namespace strongpoint {

/// A sparse system in compressed rows; columns ascend within a row. It is square, or has more rows
/// than unknowns and is solved in the least-squares sense.
struct LinearSystem {
  LargeArray<std::int64_t> offsets{0};  ///< (rows + 1)
  LargeArray<std::int64_t> columns;     ///< (entries)
  LargeArray<double> values;            ///< (entries)
  Eigen::VectorXd right_hand_side;      ///< (rows)
  LargeArray<double> row_scales;        ///< (rows) what each equation was multiplied by
  int fields = 1;                       ///< unknown = node * fields + field
  std::vector<int> field_axis;  ///< (fields) axis of a vector's component, -1 for a scalar; empty:
                                ///< all scalars; components share a unit
  std::int64_t width = 0;       ///< number of unknowns; 0: as many as rows
  int dimension = 0;            ///< of the space the nodes lie in; 0: not known
  Eigen::MatrixXd places;       ///< (dimension, nodes) of displacements; else empty
  std::vector<int> order;  ///< (nodes) in which incomplete factors eliminate them; empty: as is

  std::int64_t rows() const { return static_cast<std::int64_t>(offsets.size()) - 1; }
  std::int64_t unknowns() const { return width > 0 ? width : rows(); }
};

/// A solution of a linear system.
struct LinearSolution {
  Eigen::VectorXd x;    ///< (unknowns)
  double residual = 0;  ///< `BackwardError::of` the rows, whatever the units; of an overdetermined
                        ///< system the smaller of this and `BackwardError::of_gradient`
  int iterations = 0;   ///< 0 with a direct solver
  std::size_t bytes = 0;  ///< most memory that the solver counted beside the system; 0: not counted
  std::string solver;     ///< what solved it, where the solver has a choice; otherwise empty
};

/// Rows whose residual is above this have not been solved.
inline constexpr double largest_residual = 1e-8;

/// Names, summaries and options of all solvers.
const std::vector<EntryInfo>& solvers();

/// Canonical form of a `--solver` spec. Throws UsageError when it is malformed or unknown, or when
/// a value does not fit.
std::string canonical_solver(std::string_view spec);

/// True when a solver iterates: it then counts iterations and reads `LinearSystem::order`.
bool is_iterative(std::string_view solver);

/// Indices that sort a coordinate of the nodes, ties by index: an order for incomplete factors.
std::vector<int> order_along(const Eigen::Ref<const Eigen::VectorXd>& coordinate);

/// Solves a system whose rows are scaled to a largest entry of 1, or weighted thereafter when it is
/// overdetermined. Throws SkipCase when the solver serves square systems alone and this is not one;
/// CaseError when there are fewer rows than unknowns, the matrix is singular or of deficient rank,
/// the solution is not finite or the residual exceeds `largest_residual`.
LinearSolution solve(const LinearSystem& system, std::string_view solver);

}  // namespace strongpoint
