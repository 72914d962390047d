#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// What is tried in turn.
struct Plan {
  std::string first;
  std::string fallback;  ///< empty: none
};

/// The rule. Below the sizes given factors are as fast as an iteration. In 2D multigrid, which
/// needs the fewest iterations; in 3D ILUT, which stands tractions on several faces better.
Plan plan_for(const LinearSystem& system) {
  constexpr std::int64_t many_in_plane = 15'000;
  constexpr std::int64_t many_in_space = 5'000;
  constexpr int most_fields = 4;
  if (system.rows() > system.unknowns()) return {"normal", "spqr"};
  const bool is_blocked = system.fields <= most_fields && system.unknowns() % system.fields == 0;
  const std::int64_t many = system.dimension == 3 ? many_in_space : many_in_plane;
  if (!is_blocked || system.dimension < 2 || system.unknowns() < many) return {"umfpack", ""};
  return {system.dimension == 3 ? "bicgstab[tolerance=1e-10,iterations=300]"
                                : "bicgstab[precond=amg,tolerance=1e-10,iterations=150]",
          "umfpack"};
}

LinearSolution solve_auto(const LinearSystem& system) {
  const Plan plan = plan_for(system);
  const auto solve_by = [&](const std::string& spec) {
    LinearSolution solution = solve(system, spec);
    solution.solver = spec;
    return solution;
  };
  if (plan.fallback.empty()) return solve_by(plan.first);
  try {
    return solve_by(plan.first);
  } catch (const CaseError&) {
    return solve_by(plan.fallback);
  }
}

}  // namespace

/// Chooses by dimension, size and kind; what stalls, breaks down or leaves too large a residual is
/// solved again directly.
SolverEntry solver_auto() {
  return {{"auto",
           "least squares: normal, else spqr; below 15000 unknowns (3D: 5000) and in 1D: umfpack; "
           "above: bicgstab[precond=amg] in 2D, bicgstab in 3D, to 1e-10, umfpack when it fails",
           {}},
          Shape::overdetermined,
          Approach::iterative,
          [](const Options&) -> Solver { return solve_auto; }};
}

}  // namespace strongpoint
