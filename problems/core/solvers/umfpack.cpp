#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/solver_entry.hpp"
#include "problems/core/sparse_factor.hpp"

namespace strongpoint {
namespace {

LinearSolution solve_umfpack(const LinearSystem& system) {
  const SparseFactor factor(view_of(system));
  switch (factor.fault()) {
    case SparseFactor::Fault::none:
      break;
    case SparseFactor::Fault::singular:
      throw_singular(system, "umfpack");
    case SparseFactor::Fault::out_of_memory:
      throw_out_of_memory(system, "umfpack");
    case SparseFactor::Fault::other:
      throw CaseError(fmt::format("umfpack: failed with status {}", factor.status()));
  }
  LinearSolution solution;
  solution.x.resize(system.rows());
  factor.solve(system.right_hand_side.data(), solution.x.data(), SparseFactor::Refinement::usual);
  return solution;
}

}  // namespace

/// Direct factorisation with 64-bit indices. Source: Davis 2004, UMFPACK; full partial pivoting
/// instead of its threshold.
SolverEntry solver_umfpack() {
  return {{"umfpack", "UMFPACK's multifrontal LU with 64-bit indices", {}},
          Shape::square,
          Approach::direct,
          [](const Options&) -> Solver { return solve_umfpack; }};
}

}  // namespace strongpoint
