#include <string>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/backward_error.hpp"
#include "problems/core/solver_entry.hpp"
#include "problems/core/sparse_factor.hpp"

namespace strongpoint {
namespace {

/// How the unknowns are ordered: `choose` takes one of the other two.
enum class Choice { choose, usual, metis };

/// Whether nested dissection of the nodes pays: its analysis costs a second for 1e5 nodes and
/// 30 neighbours each. Measured against UMFPACK's defaults, seconds: 2D elasticity 6.7k nodes 0.15
/// and 0.13, 104k nodes 3.9 and 4.4; 2D Poisson, fourth order, 100k nodes 2.7 and 2.3; 3D
/// elasticity 4.7k nodes 1.1 and 1.5.
bool metis_pays(const LinearSystem& system) {
  constexpr std::int64_t many_unknowns = 100'000;
  constexpr std::int64_t some_unknowns = 5'000;
  if (system.dimension >= 3 || system.fields >= 3) return system.unknowns() >= some_unknowns;
  return system.fields == 2 && system.unknowns() >= many_unknowns;
}

void check(const SparseFactor& factor, const LinearSystem& system) {
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
}

/// Solves with factors in an order; the solution is not finite where they have a fault.
LinearSolution solve_with(const LinearSystem& system, const SparseFactor& factor) {
  LinearSolution solution;
  solution.bytes = factor.peak_bytes();
  solution.x.resize(system.rows());
  factor.solve(system.right_hand_side.data(), solution.x.data());
  return solution;
}

LinearSolution solve_umfpack(const LinearSystem& system, Choice choice) {
  using Ordering = SparseFactor::Ordering;
  const RowMajorView matrix = view_of(system);
  if (choice == Choice::metis || (choice == Choice::choose && metis_pays(system))) {
    // What is above round-off by this much lost digits to pivots on the diagonal, and is solved
    // again with full pivoting, which leaves round-off after two steps of refinement.
    constexpr double largest_residual_kept = 1e-13;
    const SparseFactor factor(matrix, Ordering::nodes, system.fields);
    if (factor.fault() == SparseFactor::Fault::out_of_memory) check(factor, system);
    if (factor.fault() == SparseFactor::Fault::none) {
      LinearSolution solution = solve_with(system, factor);
      const FieldUnits units(system);
      Eigen::VectorXd residual;
      const double size = BackwardError(system, units).of(solution.x, residual);
      if (size <= largest_residual_kept) return solution;
    }
  }
  const SparseFactor factor(matrix, Ordering::usual);
  check(factor, system);
  return solve_with(system, factor);
}

}  // namespace

/// Direct factorisation with 64-bit indices. Source: Davis 2004, UMFPACK; full partial pivoting
/// instead of its threshold where the pattern is unsymmetric; nested dissection of the nodes by
/// METIS with pivots on the diagonal, and full pivoting when that leaves more than round-off.
SolverEntry solver_umfpack() {
  return {{"umfpack",
           "UMFPACK's multifrontal LU with 64-bit indices",
           {{"ordering", "auto",
             "usual: UMFPACK's; metis: nested dissection of the nodes; auto: metis in 3D from 5000 "
             "unknowns and in 2D elasticity from 100000"}}},
          Shape::square,
          Approach::direct,
          [](const Options& options) -> Solver {
            const auto choice = options.choice<Choice>(
                "ordering",
                {{"auto", Choice::choose}, {"usual", Choice::usual}, {"metis", Choice::metis}});
            return [choice](const LinearSystem& system) { return solve_umfpack(system, choice); };
          }};
}

}  // namespace strongpoint
