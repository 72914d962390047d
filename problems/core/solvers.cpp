#include "problems/core/solvers.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/backward_error.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {

#define SOLVER(name) SolverEntry solver_##name();
#include "problems/core/solvers/solvers.def"
#undef SOLVER

namespace {

const std::vector<SolverEntry>& entries() {
  static const std::vector<SolverEntry> all{
#define SOLVER(name) solver_##name(),
#include "problems/core/solvers/solvers.def"
#undef SOLVER
  };
  return all;
}

bool is_square(const LinearSystem& system) { return system.rows() == system.unknowns(); }

void check_shape(const LinearSystem& system, const SolverEntry& entry) {
  if (system.rows() < system.unknowns()) {
    throw CaseError(fmt::format("{}: {} equations for {} unknowns; write one per unknown or more",
                                entry.info.name, system.rows(), system.unknowns()));
  }
  if (is_square(system) || entry.shape == Shape::overdetermined) return;
  std::string able;
  for (const SolverEntry& other : entries()) {
    if (other.shape != Shape::overdetermined) continue;
    able += (able.empty() ? "" : " or ") + other.info.name;
  }
  throw SkipCase(fmt::format("{} solves square systems alone; {} equations for {} unknowns take {}",
                             entry.info.name, system.rows(), system.unknowns(), able));
}

/// What the system in other units takes.
std::size_t copied_bytes(const LinearSystem& system) {
  return system.values.size() * (sizeof(double) + sizeof(std::int64_t));
}

/// Solves in units in which the numbers of a row are of one size, whatever those of the fields:
/// what judges pivots, drops small entries or stops by a norm then sees the same system in any
/// units.
LinearSolution solve_in_even_units(const LinearSystem& system, const FieldUnits& units,
                                   const Solver& solver) {
  const Eigen::VectorXd sizes = units.even_sizes();
  if ((sizes.array() == 1).all()) return solver(system);
  LinearSolution solution = solver(in_units(system, units, sizes));
  for (std::int64_t i = 0; i < system.unknowns(); ++i) {
    solution.x[i] *= sizes[units.of_unknowns()[i]];
  }
  if (solution.bytes > 0) solution.bytes += copied_bytes(system);
  return solution;
}

/// What `LinearSolution::residual` says. A small r has solved even an overdetermined system, and
/// the direction of one at round-off level means nothing, so that the better figure counts.
double residual_of(const LinearSystem& system, const BackwardError& error,
                   const Eigen::VectorXd& x) {
  Eigen::VectorXd residual;
  const double solved = error.of(x, residual);
  return is_square(system) ? solved : std::min(solved, error.of_gradient(residual));
}

}  // namespace

RowMajorView view_of(const LinearSystem& system) {
  return {
      system.rows(),         system.unknowns(),     static_cast<Eigen::Index>(system.values.size()),
      system.offsets.data(), system.columns.data(), system.values.data()};
}

void throw_singular(const LinearSystem& system, std::string_view solver) {
  const char* fault = is_square(system) ? "is singular" : "has deficient rank";
  throw CaseError(
      fmt::format("{}: the system of {} unknowns {}; check the boundary conditions and "
                  "the stencils",
                  solver, system.unknowns(), fault));
}

void throw_out_of_memory(const LinearSystem& system, std::string_view solver) {
  throw CaseError(
      fmt::format("{}: out of memory for {} unknowns; use fewer nodes", solver, system.unknowns()));
}

const std::vector<EntryInfo>& solvers() {
  static const std::vector<EntryInfo> infos = [] {
    std::vector<EntryInfo> list;
    for (const SolverEntry& entry : entries()) list.push_back(entry.info);
    return list;
  }();
  return infos;
}

std::string canonical_solver(std::string_view text) {
  const Spec spec = parse_spec(text);
  const SolverEntry& entry = find_entry(entries(), "solver", spec.name);
  const Options options(entry.info, spec);
  entry.make(options);  // refuses values that do not fit
  return options.canonical();
}

bool is_iterative(std::string_view solver) {
  const SolverEntry& entry = find_entry(entries(), "solver", parse_spec(solver).name);
  return entry.approach == Approach::iterative;
}

std::vector<int> order_along(const Eigen::Ref<const Eigen::VectorXd>& coordinate) {
  std::vector<int> order(coordinate.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return coordinate[a] < coordinate[b]; });
  return order;
}

LinearSolution solve(const LinearSystem& system, std::string_view text) {
  const Spec spec = parse_spec(text);
  const SolverEntry& entry = find_entry(entries(), "solver", spec.name);
  const Solver solver = entry.make(Options(entry.info, spec));
  check_shape(system, entry);
  const FieldUnits units(system);
  LinearSolution solution = solve_in_even_units(system, units, solver);
  if (solution.residual > 0) return solution;  // judged, by what the system was left to
  const BackwardError error(system, units);
  // No digit can be trusted of a system as close as this to a singular one.
  constexpr double least_change = 1e-14;
  if (!solution.x.allFinite() || error.of_null_vector(solution.x) < least_change) {
    throw_singular(system, entry.info.name);
  }
  solution.residual = residual_of(system, error, solution.x);
  if (!(solution.residual <= largest_residual)) {
    throw CaseError(
        fmt::format("{}: the relative residual {:.1e} exceeds {:.0e}; the system of {} "
                    "unknowns is too ill-conditioned",
                    entry.info.name, solution.residual, largest_residual, system.unknowns()));
  }
  return solution;
}

}  // namespace strongpoint
