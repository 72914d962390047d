#include <Eigen/SparseLU>

#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

LinearSolution solve_sparse_lu(const LinearSystem& system) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;
  const Matrix matrix = view_of(system);
  Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<std::int64_t>> lu;
  lu.compute(matrix);
  if (lu.info() != Eigen::Success) throw_singular(system, "sparse_lu");
  LinearSolution solution;
  solution.x = lu.solve(system.right_hand_side);
  return solution;
}

}  // namespace

/// Direct factorisation without a library beyond Eigen. Source: Li 2005, SuperLU, in Eigen's
/// version.
SolverEntry solver_sparse_lu() {
  return {{"sparse_lu", "Eigen's supernodal SparseLU", {}},
          Shape::square,
          Approach::direct,
          [](const Options&) -> Solver { return solve_sparse_lu; }};
}

}  // namespace strongpoint
