#pragma once

#include <functional>
#include <string>
#include <vector>

#include "problems/core/krylov.hpp"
#include "problems/core/preconditioner.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {

/// A product with a matrix, y = A x.
struct MatrixProduct {
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)> multiply;
};

/// What the iterative solvers have in common.
struct IterativeSettings {
  enum class Preconditioning { ilut, ilu0, amg };
  Preconditioning preconditioning = Preconditioning::ilut;
  double drop = 1e-2;  ///< of ILUT
  double fill = 2;     ///< of ILUT
  KrylovLimits limits;
  int vectors = 0;  ///< that the iteration keeps, for the count of memory
};

/// Improves x, zero at first, until it solves A x = b.
using Iteration =
    std::function<KrylovReport(const MatrixProduct& matrix, const Preconditioner& preconditioner,
                               const Eigen::VectorXd& b, Eigen::VectorXd& x)>;

/// The options of every iterative solver, and those of one.
std::vector<OptionDoc> iterative_options(const std::vector<OptionDoc>& own = {});

/// Reads the common options. Throws UsageError for values that do not fit.
IterativeSettings iterative_settings(const Options& options);

/// An iteration on a system of 1 to 4 fields: blocks of the fields at a node, nodes in the system's
/// order. Throws CaseError, on behalf of `solver`, when the fields or the order do not fit and when
/// the iteration does not converge.
LinearSolution solve_iteratively(const LinearSystem& system, const std::string& solver,
                                 const IterativeSettings& settings, const Iteration& iteration);

}  // namespace strongpoint
