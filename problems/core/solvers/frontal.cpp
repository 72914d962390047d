#include "problems/core/front_order.hpp"
#include "problems/core/frontal_factor.hpp"
#include "problems/core/node_graph.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// Largest residual, relative to the right-hand side and the largest unknown, rows having a largest
/// entry of 1.
double residual_of(const LinearSystem& system, const Eigen::VectorXd& x,
                   Eigen::VectorXd& residual) {
  residual = system.right_hand_side - view_of(system) * x;
  const double size =
      system.right_hand_side.lpNorm<Eigen::Infinity>() + x.lpNorm<Eigen::Infinity>();
  return residual.lpNorm<Eigen::Infinity>() / size;
}

/// Solves and corrects; the solution is empty where the pivots do not serve.
LinearSolution solve_in_front(const LinearSystem& system) {
  constexpr double round_off = 1e-14;
  constexpr double largest_residual_kept = 1e-13;  // as umfpack keeps with pivots on the diagonal
  constexpr int most_corrections = 2;
  const RowMajorView matrix = view_of(system);
  const NodeGraph graph = node_graph(matrix, system.fields);
  if (graph.offsets.empty()) return {};
  const FrontalFactor factor(matrix, system.fields, graph, front_order(graph));
  if (!factor.has_factors()) return {};
  LinearSolution solution;
  solution.solver = "frontal";
  solution.bytes = factor.bytes();
  solution.x.resize(system.rows());
  factor.solve(system.right_hand_side.data(), solution.x.data());
  Eigen::VectorXd residual;
  double size = residual_of(system, solution.x, residual);
  for (int i = 0; i < most_corrections && size > round_off; ++i) {
    factor.solve(residual.data(), residual.data());
    solution.x += residual;
    size = residual_of(system, solution.x, residual);
  }
  if (size <= largest_residual_kept) return solution;
  return {};
}

LinearSolution solve_frontal(const LinearSystem& system) {
  if (system.rows() > 0 && system.rows() % system.fields == 0) {
    LinearSolution solution = solve_in_front(system);
    if (solution.x.size() > 0) return solution;
  }
  LinearSolution solution = solve(system, "umfpack");
  solution.solver = "umfpack";
  return solution;
}

}  // namespace

/// Direct factorisation in a dense front that sweeps over the nodes in Sloan's order; pivots among
/// a few nodes at a time, and UMFPACK when that leaves more than round-off. Source: Irons 1970;
/// Sloan 1986.
SolverEntry solver_frontal() {
  return {{"frontal",
           "dense front sweeping over the nodes: plane problems of up to some thousand nodes with "
           "wide stencils",
           {}},
          Shape::square,
          Approach::direct,
          [](const Options&) -> Solver { return solve_frontal; }};
}

}  // namespace strongpoint
