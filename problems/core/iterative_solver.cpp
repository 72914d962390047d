#include "problems/core/iterative_solver.hpp"

#include <memory>
#include <new>
#include <numeric>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/balance.hpp"
#include "problems/core/block_amg.hpp"
#include "problems/core/block_ilut.hpp"
#include "problems/core/block_matrix.hpp"

namespace strongpoint {
namespace {

using Preconditioning = IterativeSettings::Preconditioning;

/// ILU(0) as a preconditioner.
template <int Size>
class BlockIlu0 : public Preconditioner {
 public:
  explicit BlockIlu0(const BlockMatrix<Size>& matrix)
      : Preconditioner(static_cast<Eigen::Index>(matrix.rows()) * Size),
        factors_(block_ilu0(matrix)) {}
  using Preconditioner::apply;
  void apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const override { factors_.apply(r, z); }
  int shifted_pivots() const override { return factors_.shifted; }
  std::size_t bytes() const override { return factors_.bytes(); }

 private:
  BlockFactors<Size> factors_;
};

/// Multigrid, with rigid bodies where the fields are displacements in a plane of known places.
template <int Size>
std::unique_ptr<Preconditioner> make_multigrid(const BlockMatrix<Size>& matrix,
                                               const LinearSystem& system,
                                               const std::vector<int>& order) {
  if constexpr (Size == 2) {
    const auto nodes = static_cast<Eigen::Index>(order.size());
    if (system.places.rows() == 2 && system.places.cols() == nodes) {
      const Balance balance = balance_of(system);
      typename BlockAmg<2, 3>::Plane plane{
          {Eigen::Matrix2Xd(2, nodes), Eigen::VectorXd::Zero(nodes)},
          Eigen::VectorXd(2 * nodes),
          std::vector<char>(nodes)};
      for (Eigen::Index i = 0; i < nodes; ++i) {
        plane.bodies.places.col(i) = system.places.col(order[i]);
        plane.weights.segment<2>(2 * i) =
            balance.weights.segment<2>(2 * static_cast<Eigen::Index>(order[i]));
        plane.filled[i] = balance.has_traction[order[i]];
      }
      return std::make_unique<BlockAmg<2, 3>>(matrix, typename BlockAmg<2, 3>::Parameters{},
                                              std::move(plane));
    }
  }
  return std::make_unique<BlockAmg<Size>>(matrix, typename BlockAmg<Size>::Parameters{});
}

template <int Size>
std::unique_ptr<Preconditioner> make_preconditioner(const BlockMatrix<Size>& matrix,
                                                    const LinearSystem& system,
                                                    const std::vector<int>& order,
                                                    const IterativeSettings& settings) {
  switch (settings.preconditioning) {
    case Preconditioning::ilu0:
      return std::make_unique<BlockIlu0<Size>>(matrix);
    case Preconditioning::amg:
      return make_multigrid(matrix, system, order);
    case Preconditioning::ilut:
      break;
  }
  using Parameters = typename BlockIlut<Size>::Parameters;
  return std::make_unique<BlockIlut<Size>>(matrix, Parameters{settings.drop, settings.fill});
}

/// The order in which nodes are eliminated. Throws CaseError when the one given does not list every
/// node once.
std::vector<int> elimination_order(const LinearSystem& system, const std::string& solver) {
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
          fmt::format("{}: the order of elimination names node {} of {} twice or "
                      "wrongly; list every node once",
                      solver, node, nodes));
    }
    is_listed[node] = 1;
  }
  if (static_cast<std::int64_t>(order.size()) != nodes) {
    throw CaseError(
        fmt::format("{}: the order of elimination lists {} of {} nodes; list every node once",
                    solver, order.size(), nodes));
  }
  return order;
}

/// Throws unless the iteration converged.
void check(const KrylovReport& report, int shifted_pivots, const std::string& solver) {
  if (report.outcome == KrylovOutcome::converged) return;
  const bool is_breakdown = report.outcome == KrylovOutcome::breakdown;
  const std::string pivots =
      shifted_pivots == 0 ? ""
                          : fmt::format(" ({} singular pivot blocks were shifted)", shifted_pivots);
  throw CaseError(
      fmt::format("{}: {} after {} iterations at a relative residual of {:.1e}{}; take another "
                  "precond=, with ilut a lower drop= and a higher fill=, or use umfpack",
                  solver, is_breakdown ? "broke down" : "has not converged", report.iterations,
                  report.residual, pivots));
}

template <int Size>
LinearSolution solve_blocks(const LinearSystem& system, const std::string& solver,
                            const IterativeSettings& settings, const Iteration& iteration) {
  const std::vector<int> order = elimination_order(system, solver);
  const BlockMatrix<Size> matrix = block_matrix<Size>(system, order);
  const std::unique_ptr<Preconditioner> preconditioner =
      make_preconditioner(matrix, system, order, settings);
  Eigen::VectorXd right_hand_side(system.rows());
  for (std::size_t i = 0; i < order.size(); ++i) {
    right_hand_side.segment<Size>(static_cast<Eigen::Index>(i) * Size) =
        system.right_hand_side.segment<Size>(static_cast<Eigen::Index>(order[i]) * Size);
  }
  const MatrixProduct product{
      [&matrix](const Eigen::VectorXd& from, Eigen::VectorXd& to) { matrix.multiply(from, to); }};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(system.rows());
  const KrylovReport report = iteration(product, *preconditioner, right_hand_side, x);
  check(report, preconditioner->shifted_pivots(), solver);
  LinearSolution solution;
  solution.iterations = report.iterations;
  const auto vectors = static_cast<std::size_t>(settings.vectors) + 3;  // x, b, two single ones
  solution.bytes = matrix.bytes() + preconditioner->bytes() + vectors * x.size() * sizeof(double);
  solution.x.resize(system.rows());
  for (std::size_t i = 0; i < order.size(); ++i) {
    solution.x.segment<Size>(static_cast<Eigen::Index>(order[i]) * Size) =
        x.segment<Size>(static_cast<Eigen::Index>(i) * Size);
  }
  return solution;
}

}  // namespace

std::vector<OptionDoc> iterative_options(const std::vector<OptionDoc>& own) {
  std::vector<OptionDoc> options{
      {"precond", "ilut", "ilut, ilu0 or amg: plain aggregation smoothed by ilu0"},
      {"drop", "1e-2", "of ilut: smallest block kept in the factors, relative to its row's mean"},
      {"fill", "2", "of ilut: most blocks kept in a row of the factors, relative to the matrix's"},
      {"tolerance", "1e-9", "on the residual, relative to the right-hand side, 2-norms"},
      {"iterations", "1000", "at most"}};
  options.insert(options.end(), own.begin(), own.end());
  return options;
}

IterativeSettings iterative_settings(const Options& options) {
  IterativeSettings settings;
  settings.preconditioning =
      options.choice<Preconditioning>("precond", {{"ilut", Preconditioning::ilut},
                                                  {"ilu0", Preconditioning::ilu0},
                                                  {"amg", Preconditioning::amg}});
  settings.drop = options.number("drop", 0, 1);
  settings.fill = options.number("fill", 0, 1000);
  settings.limits.tolerance = options.number("tolerance", 1e-15, 1e-2);
  settings.limits.iterations = options.integer("iterations", 1, 1000000);
  return settings;
}

LinearSolution solve_iteratively(const LinearSystem& system, const std::string& solver,
                                 const IterativeSettings& settings, const Iteration& iteration) {
  if (system.rows() % system.fields != 0) {
    throw CaseError(fmt::format("{}: {} unknowns are not {} at every node; use umfpack", solver,
                                system.rows(), system.fields));
  }
  try {
    switch (system.fields) {
      case 1:
        return solve_blocks<1>(system, solver, settings, iteration);
      case 2:
        return solve_blocks<2>(system, solver, settings, iteration);
      case 3:
        return solve_blocks<3>(system, solver, settings, iteration);
      case 4:
        return solve_blocks<4>(system, solver, settings, iteration);
      default:
        break;
    }
  } catch (const std::bad_alloc&) {
    throw_out_of_memory(system, solver);
  }
  throw CaseError(
      fmt::format("{}: {} fields at a node; it takes 1 to 4, use umfpack", solver, system.fields));
}

}  // namespace strongpoint
