#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/cholmod_session.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// Solves A^T A x = A^T r with the factor of A^T A.
Eigen::VectorXd solve_normal_equations(CholmodSession& session, cholmod_factor* factor,
                                       const RowMajorView& matrix, const Eigen::VectorXd& r) {
  const Eigen::VectorXd gradient = matrix.transpose() * r;
  cholmod_dense right_hand_side = CholmodSession::view(gradient);
  const auto x =
      take(session, cholmod_l_solve(CHOLMOD_A, factor, &right_hand_side, session.common()));
  return Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(x->x), gradient.size());
}

LinearSolution solve_normal(const LinearSystem& system) {
  CholmodSession session(system, "normal");
  session.common()->supernodal = CHOLMOD_SUPERNODAL;
  session.common()->final_ll = 1;
  const auto factor = take(session, cholmod_l_analyze(session.transposed(), session.common()));
  cholmod_l_factorize(session.transposed(), factor.get(), session.common());
  session.check();
  // The pivots of dependent columns are round-off, of some hundred units; nearer to it no pivot can
  // be told from those.
  constexpr double least_reciprocal = 1e-13;
  if (cholmod_l_rcond(factor.get(), session.common()) < least_reciprocal) {
    throw CaseError(
        fmt::format("normal: the system of {} unknowns has deficient rank, or a condition whose "
                    "square exceeds {:.0e}; use spqr, which does not square it",
                    system.unknowns(), 1 / least_reciprocal));
  }
  const RowMajorView matrix = view_of(system);
  LinearSolution solution;
  solution.x = solve_normal_equations(session, factor.get(), matrix, system.right_hand_side);
  const Eigen::VectorXd residual = system.right_hand_side - matrix * solution.x;
  solution.x += solve_normal_equations(session, factor.get(), matrix, residual);
  return solution;
}

}  // namespace

/// Normal equations by CHOLMOD's supernodal LL^T with one step of refinement on the residual r of
/// the rows: the error then is that of the condition squared times |r|, no more. Source: Björck
/// 1996, section 2.9 (fixed precision refinement).
SolverEntry solver_normal() {
  return {{"normal", "normal equations with CHOLMOD's Cholesky, one step of refinement", {}},
          Shape::overdetermined,
          Approach::direct,
          [](const Options&) -> Solver { return solve_normal; }};
}

}  // namespace strongpoint
