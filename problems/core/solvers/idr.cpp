#include "problems/core/idr.hpp"

#include "problems/core/iterative_solver.hpp"

namespace strongpoint {

/// IDR(s): short recurrences, steadier than BiCGSTAB. Source: van Gijzen and Sonneveld 2011.
SolverEntry solver_idr() {
  return {{"idr", "IDR(s) with block ILUT, ILU(0) or multigrid",
           iterative_options({{"s", "4", "dimension of the shadow space"}})},
          Shape::square,
          Approach::iterative,
          [](const Options& options) -> Solver {
            IterativeSettings settings = iterative_settings(options);
            const int s = options.integer("s", 1, 64);
            settings.vectors = 3 * s + 3;
            return [settings, s](const LinearSystem& system) {
              return solve_iteratively(
                  system, "idr", settings,
                  [&](const MatrixProduct& matrix, const Preconditioner& preconditioner,
                      const Eigen::VectorXd& b, Eigen::VectorXd& x) {
                    return Idr(b.size(), settings.limits, s).solve(matrix, preconditioner, b, x);
                  });
            };
          }};
}

}  // namespace strongpoint
