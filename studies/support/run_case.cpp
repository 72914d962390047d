#include "studies/support/run_case.hpp"

#include <algorithm>
#include <numeric>

#include "problems/core/assembly.hpp"
#include "studies/support/case_map.hpp"
#include "studies/support/release.hpp"
#include "studies/support/vtk.hpp"

namespace strongpoint {
namespace {

/// Values at the nodes, (fields, N): the nodal parameters themselves unless the weights hold the
/// value, which they do when parameters are not values.
template <int Dim>
Eigen::MatrixXd nodal_values(const Discretisation<Dim>& scene, const Eigen::MatrixXd& parameters) {
  const MultiIndex<Dim> value{};
  if (!scene.derivatives.contains(value)) return parameters.leftCols(scene.cloud.size());
  const int slot = scene.derivatives.index(value);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(parameters.rows(), scene.cloud.size());
  for (int p = 0; p < scene.cloud.size(); ++p) {  // points beyond are no nodes
    const std::span<const int> nodes = scene.weights.nodes(p);
    const Eigen::Map<const Eigen::MatrixXd> row = scene.weights.row(p);
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      result.col(p) += row(slot, static_cast<Eigen::Index>(j)) * parameters.col(nodes[j]);
    }
  }
  return result;
}

/// Where each node lies that is an unknown, (Dim, unknowns).
template <int Dim>
Eigen::MatrixXd places_of_unknowns(const Discretisation<Dim>& scene) {
  Eigen::MatrixXd places(Dim, scene.unknowns.count);
  for (int node = scene.sites.node_count() - 1; node >= 0; --node) {  // its own place comes last
    places.col(scene.unknowns.of(node)) = scene.sites.nodes.col(node);
  }
  return places;
}

/// Whether the fields are the components of a vector, in their order, and no others.
template <int Dim>
bool are_displacements(const Discretisation<Dim>& scene) {
  std::vector<int> axes(Dim);
  std::iota(axes.begin(), axes.end(), 0);
  return scene.unknowns.field_axis == axes;
}

}  // namespace

template <int Dim>
Solution<Dim> solution_of(const Discretisation<Dim>& scene, const Eigen::VectorXd& unknowns) {
  const Eigen::Index fields = unknowns.size() / scene.unknowns.count;
  const Eigen::MatrixXd parameters = scene.unknowns.spread(
      Eigen::Map<const Eigen::MatrixXd>(unknowns.data(), fields, scene.unknowns.count));
  return {scene.cloud, nodal_values(scene, parameters), parameters, scene.weights,
          scene.derivatives};
}

template <int Dim>
CaseResult solve_steady(const SteadyProblem<Dim>& problem, const CaseKey& key,
                        const RunOptions& options) {
  const StageClock clock(options.threads);
  CaseResult result;
  StageTimes& times = result.times;
  reset_peak_memory();
  const auto made = discretise(problem, key, options, times);
  Discretisation<Dim>& scene = *made;
  const int field_count = static_cast<int>(problem.fields().size());
  LinearSystem system = clock.time(times.assemble, [&] {
    return assemble(scene.equations(scene.derivatives), scene.weights, scene.unknowns, field_count);
  });
  system.dimension = Dim;
  if (is_iterative(key.solver)) {
    clock.time(times.solve, [&] {
      Eigen::MatrixXd places = places_of_unknowns(scene);
      system.order = order_along(places.row(0).transpose());
      if (are_displacements(scene)) system.places = std::move(places);
    });
  }
  if (!options.vtk) clock.time(times.solve, [&] { release_unread(problem, scene); });
  const LinearSolution linear = clock.time(times.solve, [&] { return solve(system, key.solver); });
  times.peak_mb = peak_memory_mb();
  times.residual = linear.residual;

  const Solution<Dim> solution = solution_of<Dim>(scene, linear.x);
  if (options.vtk) {
    write_vtu<Dim>(*options.vtk, key, scene.cloud,
                   case_arrays<Dim>(problem, solution, scene, *Choices<Dim>(key).method));
  }
  const std::vector<std::string> names = problem.quantities();
  const std::vector<double> values = problem.measure(solution);
  for (std::size_t q = 0; q < names.size(); ++q) {
    result.quantities.push_back({names[q], values[q], {}, {}});
  }
  result.nodes = scene.cloud.size();
  result.unknowns = system.unknowns();
  result.iterations = linear.iterations;
  result.solver = linear.solver;
  result.spacing = scene.cloud.spacing();
  return result;
}

std::vector<std::string> steady_quantities(const CaseKey& key) {
  return with_problem<SteadyProblem>(key.problem, "steady",
                                     [](const auto& problem) { return problem.quantities(); });
}

CaseResult run_steady_case(const CaseKey& key, const RunOptions& options) {
  return with_problem<SteadyProblem>(
      key.problem, "steady", [&]<int Dim>(const SteadyProblem<Dim>& problem) {
        CaseResult result = solve_steady<Dim>(problem, key, options);
        RunOptions again = options;
        again.vtk.reset();
        for (int run = 1; run < options.repeat; ++run) {
          result.times = fastest(result.times, solve_steady<Dim>(problem, key, again).times);
        }
        return result;
      });
}

StageTimes fastest(const StageTimes& a, const StageTimes& b) {
  return {.cloud = std::min(a.cloud, b.cloud),
          .prepare = std::min(a.prepare, b.prepare),
          .neighbours = std::min(a.neighbours, b.neighbours),
          .stencils = std::min(a.stencils, b.stencils),
          .weights = std::min(a.weights, b.weights),
          .assemble = std::min(a.assemble, b.assemble),
          .solve = std::min(a.solve, b.solve),
          .voronoi = std::min(a.voronoi, b.voronoi),
          .peak_mb = std::max(a.peak_mb, b.peak_mb),
          .residual = std::max(a.residual, b.residual)};
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */                            \
  template CaseResult solve_steady(const SteadyProblem<Dim>&, const CaseKey&, const RunOptions&); \
  template Solution<Dim> solution_of(const Discretisation<Dim>&, const Eigen::VectorXd&)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
