#include "problems/core/solvers.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "methods/core/error.hpp"
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

/// Largest absolute row sum and column sum.
struct Norms {
  double rows = 0;
  double columns = 0;
};

Norms norms_of(const LinearSystem& system) {
  Norms norms;
  Eigen::VectorXd columns = Eigen::VectorXd::Zero(system.unknowns());
  for (std::int64_t row = 0; row < system.rows(); ++row) {
    double sum = 0;
    for (std::int64_t i = system.offsets[row]; i < system.offsets[row + 1]; ++i) {
      sum += std::abs(system.values[i]);
      columns[system.columns[i]] += std::abs(system.values[i]);
    }
    norms.rows = std::max(norms.rows, sum);
  }
  norms.columns = columns.size() > 0 ? columns.maxCoeff() : 0;
  return norms;
}

/// True when |A| |x| / |b|, a lower bound of the condition number, says that no digit can be
/// trusted.
bool proves_singular(const LinearSystem& system, const Eigen::VectorXd& x, double norm) {
  constexpr double largest_condition = 1e14;
  return norm * x.lpNorm<Eigen::Infinity>() >
         largest_condition * system.right_hand_side.lpNorm<Eigen::Infinity>();
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

/// What `LinearSolution::residual` says. A small r has solved even an overdetermined system, and
/// the direction of one at round-off level means nothing, so that the better figure counts.
double relative_residual(const LinearSystem& system, const Eigen::VectorXd& x, const Norms& norms) {
  const RowMajorView matrix = view_of(system);
  const Eigen::VectorXd residual = system.right_hand_side - matrix * x;
  const double size = residual.lpNorm<Eigen::Infinity>();
  const double solved = ratio(size, norms.rows * x.lpNorm<Eigen::Infinity>() +
                                        system.right_hand_side.lpNorm<Eigen::Infinity>());
  if (is_square(system)) return solved;
  const Eigen::VectorXd gradient = matrix.transpose() * residual;
  return std::min(solved, ratio(gradient.lpNorm<Eigen::Infinity>(), norms.columns * size));
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
  LinearSolution solution = solver(system);
  const Norms norms = norms_of(system);
  if (!solution.x.allFinite() || proves_singular(system, solution.x, norms.rows)) {
    throw_singular(system, entry.info.name);
  }
  solution.residual = relative_residual(system, solution.x, norms);
  if (!(solution.residual <= largest_residual)) {
    throw CaseError(
        fmt::format("{}: the relative residual {:.1e} exceeds {:.0e}; the system of {} "
                    "unknowns is too ill-conditioned",
                    entry.info.name, solution.residual, largest_residual, system.unknowns()));
  }
  return solution;
}

}  // namespace strongpoint
