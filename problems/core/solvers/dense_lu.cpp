#include <Eigen/LU>
#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// Beyond this the matrix alone takes 0.5 GB.
constexpr std::int64_t most_unknowns = 8000;

LinearSolution solve_dense_lu(const LinearSystem& system) {
  if (system.rows() > most_unknowns) {
    throw CaseError(fmt::format("dense_lu: {} unknowns are too many, at most {}; take umfpack",
                                system.rows(), most_unknowns));
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu{Eigen::MatrixXd(view_of(system))};
  LinearSolution solution;
  solution.x = lu.solve(system.right_hand_side);
  return solution;
}

}  // namespace

/// Direct factorisation of the matrix with all its zeros, for small systems whose rows are long.
SolverEntry solver_dense_lu() {
  return {{"dense_lu", "Eigen's dense LU with partial pivoting, below some 1000 unknowns", {}},
          Shape::square,
          Approach::direct,
          [](const Options&) -> Solver { return solve_dense_lu; }};
}

}  // namespace strongpoint
