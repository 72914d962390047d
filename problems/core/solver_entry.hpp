#pragma once

#include <functional>
#include <string_view>

#include <Eigen/SparseCore>

#include "problems/core/solvers.hpp"

namespace strongpoint {

/// Computes `x` and `iterations` of a system; the caller judges the residual.
using Solver = std::function<LinearSolution(const LinearSystem&)>;

/// Which systems a solver serves.
enum class Shape {
  square,         ///< as many rows as unknowns
  overdetermined  ///< as many rows or more
};

/// How a solver gets at the solution.
enum class Approach { direct, iterative };

/// A registered solver.
struct SolverEntry {
  EntryInfo info;
  Shape shape;
  Approach approach;
  Solver (*make)(const Options& options);  ///< throws UsageError for values that do not fit
};

/// The matrix of a system in compressed rows, (rows, unknowns), without a copy.
using RowMajorView = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t>>;

/// The matrix of a system, which must outlive the view.
RowMajorView view_of(const LinearSystem& system);

/// Throws the CaseError of a singular matrix, or of deficient rank when there are more rows than
/// unknowns.
[[noreturn]] void throw_singular(const LinearSystem& system, std::string_view solver);

/// Throws the CaseError of a system too large for the machine.
[[noreturn]] void throw_out_of_memory(const LinearSystem& system, std::string_view solver);

}  // namespace strongpoint
