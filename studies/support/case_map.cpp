#include "studies/support/case_map.hpp"

#include <limits>

#include "studies/support/stencil_quality.hpp"
#include "studies/support/vtk.hpp"

namespace strongpoint {
namespace {

/// Anchors at nodes whose stencil is wanted; points beyond are no nodes.
template <int Dim>
std::vector<int> anchors_of_nodes(const Discretisation<Dim>& scene) {
  std::vector<int> anchors;
  for (int a : scene.sites.wanted_anchors()) {
    const int node = scene.sites.anchor_node[a];
    if (node >= 0 && node < scene.cloud.size()) anchors.push_back(a);
  }
  return anchors;
}

/// Appends what the anchors at nodes have of a figure, unless there is a reason why it lacks.
template <int Dim>
void append_figure(const std::string& name, const Discretisation<Dim>& scene,
                   const std::vector<int>& anchors, const PerAnchor& figure,
                   std::vector<NodeArray>& arrays) {
  if (!figure.reason.empty()) return;
  NodeArray array{name, Eigen::MatrixXd::Constant(1, scene.cloud.size(),
                                                  std::numeric_limits<double>::quiet_NaN())};
  for (int a : anchors) array.values(0, scene.sites.anchor_node[a]) = figure.values[a];
  arrays.push_back(std::move(array));
}

}  // namespace

template <int Dim>
std::vector<NodeArray> field_arrays(const SteadyProblem<Dim>& problem,
                                    const Solution<Dim>& solution) {
  std::vector<NodeArray> arrays;
  const std::vector<std::string> names = problem.fields();
  for (std::size_t f = 0; f < names.size(); ++f) {
    arrays.push_back({names[f], solution.fields.row(static_cast<Eigen::Index>(f))});
  }
  return arrays;
}

template <int Dim>
std::vector<NodeArray> stencil_arrays(const Discretisation<Dim>& scene, const Method<Dim>& method) {
  std::vector<NodeArray> arrays;
  const std::vector<int> anchors = anchors_of_nodes(scene);
  append_figure("stencil_size", scene, anchors, stencil_sizes<Dim>(scene, method), arrays);
  if (method.default_stencil() != every_node) {
    append_figure(
        "condition_two", scene, anchors,
        stencil_conditions<Dim>(scene, method, anchors, Scaling::both, ConditionNorm::two), arrays);
  }
  std::vector<Zone> zones(scene.cloud.size(), Zone::interior);
  for (int i = 0; i < scene.cloud.size(); ++i) {
    if (scene.cloud.is_boundary(i)) zones[i] = Zone::boundary;
  }
  arrays.push_back(zone_array(zones));
  return arrays;
}

template <int Dim>
std::vector<NodeArray> case_arrays(const SteadyProblem<Dim>& problem, const Solution<Dim>& solution,
                                   const Discretisation<Dim>& scene, const Method<Dim>& method) {
  std::vector<NodeArray> arrays = field_arrays<Dim>(problem, solution);
  for (NodeArray& derived : problem.derived_fields(solution)) arrays.push_back(std::move(derived));
  for (NodeArray& array : stencil_arrays<Dim>(scene, method)) arrays.push_back(std::move(array));
  return arrays;
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */            \
  template std::vector<NodeArray> field_arrays<Dim>(const SteadyProblem<Dim>&,    \
                                                    const Solution<Dim>&);        \
  template std::vector<NodeArray> stencil_arrays<Dim>(const Discretisation<Dim>&, \
                                                      const Method<Dim>&);        \
  template std::vector<NodeArray> case_arrays<Dim>(const SteadyProblem<Dim>&,     \
                                                   const Solution<Dim>&,          \
                                                   const Discretisation<Dim>&, const Method<Dim>&)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
