#include "problems/core/backward_error.hpp"
#include "problems/core/front_order.hpp"
#include "problems/core/frontal_factor.hpp"
#include "problems/core/node_graph.hpp"
#include "problems/core/solver_entry.hpp"

namespace strongpoint {
namespace {

/// Solves and corrects; the solution is empty where the pivots or the precision do not serve.
template <class Real>
LinearSolution solve_in_front(const LinearSystem& system, const BackwardError& error,
                              const NodeGraph& graph, std::span<const int> order,
                              int most_corrections) {
  constexpr double round_off = 1e-14;
  constexpr double largest_residual_kept = 1e-13;  // as umfpack keeps with pivots on the diagonal
  constexpr double least_gain = 0.25;              // of a correction that another one may follow
  const FrontalFactor<Real> factor(view_of(system), system.fields, graph, order);
  if (!factor.has_factors()) return {};
  LinearSolution solution;
  solution.solver = "frontal";
  solution.bytes = factor.bytes();
  solution.x = Eigen::VectorXd::Zero(system.rows());
  Eigen::VectorXd residual = system.right_hand_side;
  double size = residual.isZero(0) ? 0 : 1;
  for (int i = 0; i <= most_corrections && size > round_off; ++i) {
    const double unit = residual.lpNorm<Eigen::Infinity>();  // small numbers stay within range
    residual /= unit;
    factor.solve(residual.data(), residual.data());
    solution.x += unit * residual;
    const double before = size;
    size = error.of(solution.x, residual);
    if (!(size < least_gain * before)) break;
  }
  if (size <= largest_residual_kept) return solution;
  return {};
}

/// The solution by factors of either precision, the fast one first.
LinearSolution solve_in_fronts(const LinearSystem& system) {
  constexpr int most_corrections_of_single = 8;
  constexpr int most_corrections = 2;
  const NodeGraph graph = node_graph(view_of(system), system.fields);
  if (graph.offsets.empty()) return {};
  const std::vector<int> order = front_order(graph);
  const FieldUnits units(system);
  const BackwardError error(system, units);
  LinearSolution solution =
      solve_in_front<float>(system, error, graph, order, most_corrections_of_single);
  if (solution.x.size() > 0) return solution;
  return solve_in_front<double>(system, error, graph, order, most_corrections);
}

LinearSolution solve_frontal(const LinearSystem& system) {
  if (system.rows() > 0 && system.rows() % system.fields == 0) {
    LinearSolution solution = solve_in_fronts(system);
    if (solution.x.size() > 0) return solution;
  }
  LinearSolution solution = solve(system, "umfpack");
  solution.solver = "umfpack";
  return solution;
}

}  // namespace

/// Direct factorisation in a dense front that sweeps over the nodes in Sloan's order; pivots among
/// a few nodes at a time. Factors are of single precision, corrected by residuals of double
/// precision to a residual of 1e-14 in every row; where that stalls (conditions beyond some 1e6) of
/// double precision, and UMFPACK's when that leaves more than 1e-13. Source: Irons 1970; Sloan
/// 1986; Wilkinson 1963 (iterative refinement).
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
