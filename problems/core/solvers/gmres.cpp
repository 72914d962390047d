#include "problems/core/gmres.hpp"

#include "problems/core/iterative_solver.hpp"

namespace strongpoint {

/// Restarted GMRES: one product a step and a residual that never grows, for `restart` vectors.
/// Source: Saad and Schultz 1986.
SolverEntry solver_gmres() {
  return {{"gmres", "restarted GMRES with block ILUT, ILU(0) or multigrid",
           iterative_options({{"restart", "50", "steps between restarts, vectors kept"}})},
          Shape::square,
          Approach::iterative,
          [](const Options& options) -> Solver {
            IterativeSettings settings = iterative_settings(options);
            const int restart = options.integer("restart", 1, 1000);
            settings.vectors = restart + 3;
            return [settings, restart](const LinearSystem& system) {
              return solve_iteratively(
                  system, "gmres", settings,
                  [&](const MatrixProduct& matrix, const Preconditioner& preconditioner,
                      const Eigen::VectorXd& b, Eigen::VectorXd& x) {
                    return Gmres(b.size(), settings.limits, restart)
                        .solve(matrix, preconditioner, b, x);
                  });
            };
          }};
}

}  // namespace strongpoint
