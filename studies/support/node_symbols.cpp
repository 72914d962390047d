#include "studies/support/node_symbols.hpp"

#include <algorithm>
#include <cmath>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// The nodes inside the domain nearest to its middle, ascending by distance, then by id.
template <int Dim>
std::vector<int> middle_nodes(const PointCloud<Dim>& cloud, const Domain<Dim>& domain, int count) {
  const Point<Dim> middle = domain.map(Point<Dim>::Constant(0.5));
  std::vector<std::pair<double, int>> inner;
  inner.reserve(static_cast<std::size_t>(cloud.size()));
  for (int node = 0; node < cloud.size(); ++node) {
    if (!cloud.is_boundary(node)) {
      inner.emplace_back((cloud.nodes.col(node) - middle).squaredNorm(), node);
    }
  }
  if (inner.empty())
    throw CaseError("every node lies on the boundary or on an interface; raise the level");
  const auto taken = std::min(inner.size(), static_cast<std::size_t>(count));
  std::partial_sort(inner.begin(), inner.begin() + static_cast<std::ptrdiff_t>(taken), inner.end());
  std::vector<int> nodes;
  nodes.reserve(taken);
  for (std::size_t i = 0; i < taken; ++i) nodes.push_back(inner[i].second);
  return nodes;
}

/// Wants the stencils that rows read, and those of their nodes, no others.
template <int Dim>
void want_only(Discretisation<Dim>& scene, const EquationList& equations,
               const std::vector<int>& nodes, int fields) {
  std::fill(scene.sites.wanted.begin(), scene.sites.wanted.end(), 0);
  const auto want = [&](int point) { scene.sites.wanted[scene.sites.point_anchor[point]] = 1; };
  for (const int node : nodes) {
    want(node);
    const int first = scene.unknowns.of(node) * fields;
    for (int row = first; row < first + fields; ++row) {
      for (const Term& term : equations.row(row)) {
        if (term.derivative != value_only) want(term.point);
      }
    }
  }
}

/// Lays out the discrete system of a case, without stencils, in a scene that stays where it is.
template <int Dim>
EquationList lay_out(Discretisation<Dim>& scene, const SteadyProblem<Dim>& space,
                     const CaseKey& key, const Choices<Dim>& choices, const RunOptions& options) {
  const std::unique_ptr<Form<Dim>> form = make_form<Dim>(key.form);
  if (const std::string why = form->unsupported(space, *choices.method); !why.empty()) {
    throw SkipCase(why);
  }
  scene.cloud = make_case_cloud<Dim>(space.domain(), key, options);
  if (!scene.cloud.parts.empty() && !form->joins_parts()) {
    throw SkipCase("the form does not join blocks or patches; take collocation with its defaults");
  }
  Plan<Dim> plan = form->plan(space, scene.cloud, *choices.method);
  scene.derivatives = plan.derivatives;
  scene.sites = std::move(plan.sites);
  scene.unknowns = std::move(plan.unknowns);
  return plan.equations(scene.derivatives);
}

}  // namespace

template <int Dim>
double mean_spacing(const PointCloud<Dim>& cloud) {
  double cells = cloud.size();
  if (Dim == 1) cells -= 1;
  if (Dim > 1 && cloud.block) {
    cells = 1;
    for (const int count : cloud.block->shape) cells *= count - 1;
  }
  return std::pow(cloud.measure / cells, 1.0 / Dim);
}

template <int Dim>
WaveSymbols<Dim> node_symbols(const TransientProblem<Dim>& problem, const CaseKey& key, int count,
                              const RunOptions& options) {
  const SteadyProblem<Dim>& space = problem.space();
  const Choices<Dim> choices(key);
  Discretisation<Dim> scene;
  const EquationList equations = lay_out<Dim>(scene, space, key, choices, options);
  const PointCloud<Dim>& cloud = scene.cloud;
  const std::vector<int> nodes = middle_nodes<Dim>(cloud, space.domain(), count);
  WaveSymbols<Dim> symbols{ExactSymbol<Dim>(space, node_of(cloud, nodes[0]).place()),
                           {},
                           mean_spacing<Dim>(cloud),
                           cloud.size(),
                           cloud.spacing()};
  const int fields = symbols.exact.fields();
  want_only<Dim>(scene, equations, nodes, fields);
  StageTimes times;
  compute_weights<Dim>(scene, space.domain(), choices, options, StageClock(options.threads), times);
  const MultiIndex<Dim> value{};
  const int value_slot =
      scene.derivatives.contains(value) ? scene.derivatives.index(value) : value_only;
  for (const int node : nodes) {
    symbols.nodes.emplace_back(equations, scene.unknowns.of(node) * fields, fields, scene.weights,
                               scene.sites.nodes, node, value_slot);
  }
  return symbols;
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */                      \
  template double mean_spacing(const PointCloud<Dim>&);                                     \
  template WaveSymbols<Dim> node_symbols(const TransientProblem<Dim>&, const CaseKey&, int, \
                                         const RunOptions&)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
