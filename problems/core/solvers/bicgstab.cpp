#include "problems/core/bicgstab.hpp"

#include <new>
#include <numeric>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/block_ilut.hpp"
#include "problems/core/block_matrix.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// The options of the solver.
struct Settings {
  double drop, fill;
  Bicgstab::Parameters iteration;
};

/// The order in which nodes are eliminated. Throws CaseError when the one given does not list every
/// node once.
std::vector<int> elimination_order(const LinearSystem& system) {
  const std::int64_t nodes = system.rows() / system.fields;
  std::vector<int> order = system.order;
  if (order.empty()) {
    order.resize(nodes);
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
  std::vector<char> is_listed(nodes, 0);
  for (const int node : order) {
    if (node < 0 || node >= nodes || is_listed[node] != 0) {
      throw CaseError(
          fmt::format("bicgstab: the order of elimination names node {} of {} twice or "
                      "wrongly; list every node once",
                      node, nodes));
    }
    is_listed[node] = 1;
  }
  if (static_cast<std::int64_t>(order.size()) != nodes) {
    throw CaseError(
        fmt::format("bicgstab: the order of elimination lists {} of {} nodes; list every node once",
                    order.size(), nodes));
  }
  return order;
}

/// Throws unless the iteration converged.
void check(const Bicgstab::Report& report, int shifted_pivots) {
  if (report.outcome == Bicgstab::Outcome::converged) return;
  const bool is_breakdown = report.outcome == Bicgstab::Outcome::breakdown;
  const std::string pivots =
      shifted_pivots == 0 ? ""
                          : fmt::format(" ({} singular pivot blocks were shifted)", shifted_pivots);
  throw CaseError(
      fmt::format("bicgstab: {} after {} iterations at a relative residual of {:.1e}{}; lower "
                  "drop=, raise fill= or use umfpack",
                  is_breakdown ? "broke down" : "has not converged", report.iterations,
                  report.residual, pivots));
}

template <int Size>
LinearSolution solve_blocks(const LinearSystem& system, const Settings& settings) {
  const std::vector<int> order = elimination_order(system);
  const BlockMatrix<Size> matrix = block_matrix<Size>(system, order);
  const BlockIlut<Size> factors(matrix, {settings.drop, settings.fill});
  const auto gather = [&](const Eigen::VectorXd& from) {
    Eigen::VectorXd to(from.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      to.segment<Size>(static_cast<Eigen::Index>(i) * Size) =
          from.segment<Size>(static_cast<Eigen::Index>(order[i]) * Size);
    }
    return to;
  };
  const Eigen::VectorXd right_hand_side = gather(system.right_hand_side);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(system.rows());
  const Bicgstab::Report report =
      Bicgstab(system.rows(), settings.iteration).solve(matrix, factors, right_hand_side, x);
  check(report, factors.shifted_pivots());
  LinearSolution solution;
  solution.iterations = report.iterations;
  solution.x.resize(system.rows());
  for (std::size_t i = 0; i < order.size(); ++i) {
    solution.x.segment<Size>(static_cast<Eigen::Index>(order[i]) * Size) =
        x.segment<Size>(static_cast<Eigen::Index>(i) * Size);
  }
  return solution;
}

LinearSolution solve_bicgstab(const LinearSystem& system, const Settings& settings) {
  if (system.rows() % system.fields != 0) {
    throw CaseError(fmt::format("bicgstab: {} unknowns are not {} at every node; use umfpack",
                                system.rows(), system.fields));
  }
  try {
    switch (system.fields) {
      case 1:
        return solve_blocks<1>(system, settings);
      case 2:
        return solve_blocks<2>(system, settings);
      case 3:
        return solve_blocks<3>(system, settings);
      case 4:
        return solve_blocks<4>(system, settings);
      default:
        break;
    }
  } catch (const std::bad_alloc&) {
    throw_out_of_memory(system, "bicgstab");
  }
  throw CaseError(
      fmt::format("bicgstab: {} fields at a node; it takes 1 to 4, use umfpack", system.fields));
}

}  // namespace

/// BiCGSTAB with block ILUT, for 3D: blocks of the fields at a node, nodes in the system's order.
/// Source: van der Vorst 1992; Saad 1994.
SolverEntry solver_bicgstab() {
  return {{"bicgstab",
           "BiCGSTAB with block ILUT, for 3D",
           {{"drop", "1e-2", "smallest block kept in the factors, relative to its row's mean"},
            {"fill", "2", "most blocks kept in a row of the factors, relative to the matrix row's"},
            {"tolerance", "1e-9", "on the residual, relative to the right-hand side, 2-norms"},
            {"iterations", "1000", "at most"}}},
          Shape::square,
          Approach::iterative,
          [](const Options& options) -> Solver {
            const Settings settings{options.number("drop", 0, 1),
                                    options.number("fill", 0, 1000),
                                    {.tolerance = options.number("tolerance", 1e-15, 1e-2),
                                     .iterations = options.integer("iterations", 1, 1000000)}};
            return
                [settings](const LinearSystem& system) { return solve_bicgstab(system, settings); };
          }};
}

}  // namespace strongpoint
