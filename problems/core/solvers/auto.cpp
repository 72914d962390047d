#include <stdexcept>
#include <string>
#include <vector>

#include "methods/core/error.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// Solvers to try in turn. Below the sizes given factors are as fast as an iteration. In 2D
/// multigrid takes the fewest iterations; in 3D with tractions on several faces it takes more than
/// ILU(0) alone, which costs half of ILUT. What stalls in 2D goes to MUMPS: with 1e6 nodes of
/// Cook's membrane it takes 6.5 GB, where UMFPACK does not fit into 20 GB.
std::vector<std::string> plan_for(const LinearSystem& system) {
  constexpr std::int64_t many_in_plane = 15'000;
  constexpr std::int64_t many_in_space = 5'000;
  constexpr int most_fields = 4;
  if (system.rows() > system.unknowns()) return {"normal", "spqr"};
  const bool is_blocked = system.fields <= most_fields && system.unknowns() % system.fields == 0;
  const std::int64_t many = system.dimension == 3 ? many_in_space : many_in_plane;
  if (is_blocked && system.dimension == 2 && system.unknowns() < many) return {"frontal"};
  if (!is_blocked || system.dimension < 2 || system.unknowns() < many) return {"umfpack"};
  if (system.dimension == 2) {
    return {"bicgstab[precond=amg,tolerance=1e-10,iterations=80]", "mumps", "umfpack"};
  }
  return {"bicgstab[precond=ilu0,tolerance=1e-10,iterations=200]",
          "bicgstab[tolerance=1e-10,iterations=300]", "umfpack"};
}

LinearSolution solve_auto(const LinearSystem& system) {
  const std::vector<std::string> plan = plan_for(system);
  for (const std::string& spec : plan) {
    try {
      LinearSolution solution = solve(system, spec);
      if (solution.solver.empty()) solution.solver = spec;
      return solution;
    } catch (const CaseError&) {
      if (spec == plan.back()) throw;
    }
  }
  throw std::logic_error("a plan without solvers");
}

}  // namespace

/// Chooses by dimension, size and kind; what stalls, breaks down or leaves too large a residual is
/// solved again directly.
SolverEntry solver_auto() {
  return {
      {"auto",
       "least squares: normal, else spqr; in 2D below 15000 unknowns: frontal; in 1D, and in 3D "
       "below 5000: umfpack; above: bicgstab to 1e-10, precond=amg in 2D, in 3D ilu0, else ilut; "
       "when it fails umfpack, in 2D mumps first",
       {}},
      Shape::overdetermined,
      Approach::iterative,
      [](const Options&) -> Solver { return solve_auto; }};
}

}  // namespace strongpoint
