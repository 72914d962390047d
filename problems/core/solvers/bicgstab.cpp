#include "problems/core/bicgstab.hpp"

#include "problems/core/iterative_solver.hpp"

namespace strongpoint {

/// BiCGSTAB, with block ILUT in 3D or multigrid. Source: van der Vorst 1992; Saad 1994.
SolverEntry solver_bicgstab() {
  return {{"bicgstab", "BiCGSTAB with block ILUT, ILU(0) or multigrid", iterative_options()},
          Shape::square,
          Approach::iterative,
          [](const Options& options) -> Solver {
            IterativeSettings settings = iterative_settings(options);
            settings.vectors = 6;
            return [settings](const LinearSystem& system) {
              return solve_iteratively(
                  system, "bicgstab", settings,
                  [&](const MatrixProduct& matrix, const Preconditioner& preconditioner,
                      const Eigen::VectorXd& b, Eigen::VectorXd& x) {
                    return Bicgstab(b.size(), settings.limits).solve(matrix, preconditioner, b, x);
                  });
            };
          }};
}

}  // namespace strongpoint
