#include <limits>

#include <SuiteSparseQR.hpp>

#include "problems/core/cholmod_session.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// Length below which a column of R counts as zero: the round-off of the factorisation, as for the
/// rank of a dense matrix. SPQR's own is 20 times larger and finds fine clouds deficient.
double rank_tolerance(const LinearSystem& system) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(system.unknowns());
  for (std::size_t i = 0; i < system.values.size(); ++i) {
    squares[system.columns[i]] += system.values[i] * system.values[i];
  }
  const auto size = static_cast<double>(system.rows() + system.unknowns());
  return size * std::numeric_limits<double>::epsilon() * std::sqrt(squares.maxCoeff());
}

LinearSolution solve_spqr(const LinearSystem& system) {
  CholmodSession session(system, "spqr");
  const auto matrix = take(session, cholmod_l_transpose(session.transposed(), 1, session.common()));
  cholmod_dense right_hand_side = CholmodSession::view(system.right_hand_side);
  const auto x =
      take(session, SuiteSparseQR<double>(SPQR_ORDERING_DEFAULT, rank_tolerance(system),
                                          matrix.get(), &right_hand_side, session.common()));
  constexpr int rank_place = 4;  // in SPQR's integer statistics
  if (session.common()->SPQR_istat[rank_place] < system.unknowns()) throw_singular(system, "spqr");
  LinearSolution solution;
  solution.x =
      Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(x->x), system.unknowns());
  return solution;
}

}  // namespace

/// Orthogonal factorisation, which does not square the condition number. Source: Davis 2011,
/// SuiteSparseQR.
SolverEntry solver_spqr() {
  return {{"spqr", "SuiteSparseQR, least squares when there are more equations than unknowns", {}},
          Shape::overdetermined,
          Approach::direct,
          [](const Options&) -> Solver { return solve_spqr; }};
}

}  // namespace strongpoint
