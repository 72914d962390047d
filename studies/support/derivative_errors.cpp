#include "studies/support/derivative_errors.hpp"

#include <array>

#include "problems/core/norms.hpp"
#include "studies/support/vtk.hpp"

namespace strongpoint {
namespace {

/// Zone names, in the order of the quantities.
constexpr std::array<std::pair<Zone, const char*>, 2> zones{
    {{Zone::interior, "interior"}, {Zone::boundary, "boundary"}}};

template <int Dim>
Derivatives<Dim> judged(const FieldProblem<Dim>& problem, const Method<Dim>& method) {
  Derivatives<Dim> all;
  if (!method.promises().interpolates) all.merge({MultiIndex<Dim>{}});
  all.merge(problem.derivatives());
  return all;
}

template <int Dim>
std::vector<std::string> names_of(const Derivatives<Dim>& derivatives) {
  std::vector<std::string> names;
  for (const auto& [zone, suffix] : zones) {
    for (const MultiIndex<Dim>& alpha : derivatives) {
      names.push_back(name_of<Dim>(alpha) + "_" + suffix);
    }
  }
  return names;
}

/// Derivatives at every point by the weights, (derivatives, points).
Eigen::MatrixXd apply(const Weights& weights, const Eigen::VectorXd& values) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(weights.per_entry, weights.size());
  for (int p = 0; p < weights.size(); ++p) {
    const std::span<const int> nodes = weights.nodes(p);
    const Eigen::Map<const Eigen::MatrixXd> row = weights.row(p);
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      result.col(p) += row.col(static_cast<Eigen::Index>(j)) * values[nodes[j]];
    }
  }
  return result;
}

/// Relative error of one derivative over the nodes of one zone; none where the derivative vanishes.
Quantity zone_error(const std::string& name, const Eigen::VectorXd& computed,
                    const Eigen::VectorXd& exact, const std::vector<Zone>& zone_of, Zone zone) {
  std::vector<Eigen::Index> nodes;
  for (std::size_t i = 0; i < zone_of.size(); ++i) {
    if (zone_of[i] == zone) nodes.push_back(static_cast<Eigen::Index>(i));
  }
  if (nodes.empty()) return {name, {}, "no node lies in this zone", {}};
  const Eigen::VectorXd a = computed(nodes);
  const Eigen::VectorXd b = exact(nodes);
  if (b.norm() > 0) return {name, relative_error(a, b), {}, {}};
  return {name, {}, "the exact derivative is zero: there is no relative error", {}};
}

/// Writes the size of each derivative's error at every node, and the zone (1 at the boundary).
template <int Dim>
void write_errors(const RunOptions& options, const CaseKey& key, const Discretisation<Dim>& scene,
                  const Eigen::MatrixXd& errors) {
  std::vector<NodeArray> arrays;
  arrays.reserve(static_cast<std::size_t>(scene.derivatives.size()) + 1);
  for (int d = 0; d < scene.derivatives.size(); ++d) {
    arrays.push_back({name_of<Dim>(scene.derivatives[d]) + "_error", errors.row(d).cwiseAbs()});
  }
  arrays.push_back(zone_array(scene.sites.anchor_zone));
  write_vtu<Dim>(*options.vtk, key, scene.cloud, arrays);
}

}  // namespace

template <int Dim>
std::vector<std::string> derivative_error_names(const FieldProblem<Dim>& problem,
                                                const Method<Dim>& method) {
  return names_of(judged(problem, method));
}

template <int Dim>
Discretisation<Dim> discretise_field(const FieldProblem<Dim>& problem, const CaseKey& key,
                                     const RunOptions& options, StageTimes& times) {
  const StageClock clock(options.threads);
  const Choices<Dim> choices(key);
  Discretisation<Dim> scene;
  scene.derivatives = judged(problem, *choices.method);
  scene.cloud =
      clock.time(times.cloud, [&] { return make_case_cloud<Dim>(problem.domain(), key, options); });
  scene.sites = clock.time(times.prepare, [&] { return sites_of_cloud<Dim>(scene.cloud); });
  compute_weights<Dim>(scene, problem.domain(), choices, options, clock, times);
  return scene;
}

template <int Dim>
std::vector<Quantity> derivative_errors(const FieldProblem<Dim>& problem, const CaseKey& key,
                                        const RunOptions& options,
                                        const Discretisation<Dim>& scene) {
  const Derivatives<Dim> value{MultiIndex<Dim>{}};
  Eigen::VectorXd values(scene.cloud.size());
  Eigen::MatrixXd exact(scene.derivatives.size(), scene.cloud.size());
  for (int i = 0; i < scene.cloud.size(); ++i) {
    values[i] = problem.exact(scene.cloud.nodes.col(i), value)[0];
    exact.col(i) = problem.exact(scene.cloud.nodes.col(i), scene.derivatives);
  }
  const Eigen::MatrixXd computed = apply(scene.weights, values);
  if (options.vtk) write_errors<Dim>(options, key, scene, computed - exact);
  std::vector<Quantity> result;
  const std::vector<std::string> names = names_of(scene.derivatives);
  for (std::size_t q = 0; q < names.size(); ++q) {
    const auto d = static_cast<Eigen::Index>(q) % exact.rows();
    const Zone zone = zones[q / static_cast<std::size_t>(exact.rows())].first;
    result.push_back(
        zone_error(names[q], computed.row(d), exact.row(d), scene.sites.anchor_zone, zone));
  }
  return result;
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same list for each dimension */                    \
  template std::vector<std::string> derivative_error_names<Dim>(const FieldProblem<Dim>&,      \
                                                                const Method<Dim>&);           \
  template Discretisation<Dim> discretise_field<Dim>(const FieldProblem<Dim>&, const CaseKey&, \
                                                     const RunOptions&, StageTimes&);          \
  template std::vector<Quantity> derivative_errors<Dim>(                                       \
      const FieldProblem<Dim>&, const CaseKey&, const RunOptions&, const Discretisation<Dim>&)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
