#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/norms.hpp"
#include "studies/support/run_case.hpp"
#include "studies/support/seeds.hpp"
#include "studies/support/study.hpp"
#include "studies/support/vtk.hpp"

namespace strongpoint {
namespace {

/// Zone names, in the order of the quantities.
constexpr std::array<std::pair<Zone, const char*>, 2> zones{
    {{Zone::interior, "interior"}, {Zone::boundary, "boundary"}}};

/// The derivatives judged: the value too, where a method does not take it from the node.
template <int Dim>
Derivatives<Dim> judged(const FieldProblem<Dim>& problem, const Method<Dim>& method) {
  Derivatives<Dim> all;
  if (!method.promises().interpolates) all.merge({MultiIndex<Dim>{}});
  all.merge(problem.derivatives());
  return all;
}

std::vector<std::string> quantities(const CaseKey& key, const Options&) {
  return with_problem<FieldProblem>(key.problem, "field",
                                    [&]<int Dim>(const FieldProblem<Dim>& problem) {
                                      std::vector<std::string> names;
                                      const auto method = make_method<Dim>(key.method).made;
                                      for (const auto& [zone, suffix] : zones) {
                                        for (const auto& alpha : judged(problem, *method)) {
                                          names.push_back(name_of<Dim>(alpha) + "_" + suffix);
                                        }
                                      }
                                      return names;
                                    });
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
  for (int d = 0; d < scene.derivatives.size(); ++d) {
    const Eigen::VectorXd sizes = errors.row(d).cwiseAbs();
    arrays.push_back({name_of<Dim>(scene.derivatives[d]) + "_error", {sizes.begin(), sizes.end()}});
  }
  arrays.push_back(zone_array(scene.sites.anchor_zone));
  write_vtu<Dim>(*options.vtk, key, scene.cloud.nodes, arrays);
}

template <int Dim>
CaseResult run(const FieldProblem<Dim>& problem, const CaseKey& key, const RunOptions& options) {
  CaseResult result;
  const StageClock clock(options.threads);
  const Choices<Dim> choices(key);
  Discretisation<Dim> scene;
  scene.derivatives = judged(problem, *choices.method);
  scene.cloud = make_case_cloud<Dim>(problem.domain(), key, options);
  scene.sites = sites_of_cloud<Dim>(scene.cloud);
  compute_weights<Dim>(scene, problem.domain(), choices, options, clock, result.times);

  const Derivatives<Dim> value{MultiIndex<Dim>{}};
  Eigen::VectorXd values(scene.cloud.size());
  Eigen::MatrixXd exact(scene.derivatives.size(), scene.cloud.size());
  for (int i = 0; i < scene.cloud.size(); ++i) {
    values[i] = problem.exact(scene.cloud.nodes.col(i), value)[0];
    exact.col(i) = problem.exact(scene.cloud.nodes.col(i), scene.derivatives);
  }
  const Eigen::MatrixXd computed = apply(scene.weights, values);
  if (options.vtk) write_errors<Dim>(options, key, scene, computed - exact);
  for (const auto& [zone, suffix] : zones) {
    for (int d = 0; d < scene.derivatives.size(); ++d) {
      const std::string name = name_of<Dim>(scene.derivatives[d]) + "_" + suffix;
      result.quantities.push_back(
          zone_error(name, computed.row(d), exact.row(d), scene.sites.anchor_zone, zone));
    }
  }
  result.nodes = scene.cloud.size();
  result.unknowns = 0;
  result.spacing = scene.cloud.spacing();
  return result;
}

int seeds_of(const Options& extra) { return extra.integer("seeds", 1, 1000); }

/// The case on clouds of several seeds; what cannot be computed on one of them is told, and ends
/// the case only when it cannot be computed on any.
template <int Dim>
CaseResult run_seeds(const FieldProblem<Dim>& problem, const CaseKey& key,
                     const RunOptions& options, int seeds) {
  std::vector<CaseResult> results;
  std::string failures;
  const std::vector<std::string> clouds = with_seeds(key.cloud, options.seed, seeds);
  for (const std::string& cloud : clouds) {
    CaseKey one = key;
    one.cloud = cloud;
    try {
      results.push_back(run<Dim>(problem, one, options));
    } catch (const CaseError& error) {
      failures += fmt::format("{}{}: {}", failures.empty() ? "" : "; ", cloud, error.what());
    }
  }
  if (results.empty()) throw CaseError(failures);
  CaseResult joined = median_of(results);
  for (Quantity& quantity : joined.quantities) {
    quantity.extra[0] = fmt::format("{}", clouds.size());
    if (!failures.empty()) quantity.reason = failures;
  }
  return joined;
}

}  // namespace
}  // namespace strongpoint

/// Errors of derivative weights on a smooth function, derivative by derivative, interior and
/// boundary apart, medians over clouds of several seeds.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "local_accuracy";
  study.summary = "errors of derivative weights on a smooth function, by derivative and zone";
  study.defaults.problem = "field";
  study.defaults.method = "mfpm,gfdm,lsfdm,rbf_fd";
  study.defaults.cloud = "grid,perturbed,perturbed[amount=0.4],scattered,random";
  study.defaults.levels = "11,21,41,81";
  study.mapped = true;
  study.quantities = quantities;
  study.extra_columns = {"seeds", "low", "high"};
  study.extra_options = {
      {"seeds", "3",
       "clouds of consecutive seeds that a case with random nodes is run on, 1 "
       "to 1000: value is the median, low and high are the smallest and largest"}};
  study.keeps = [](const CaseKey& key, const std::vector<std::string>& columns,
                   const Options& extra) {
    return columns[0] == fmt::format("{}", with_seeds(key.cloud, 1, seeds_of(extra)).size());
  };
  study.run = [](const CaseKey& key, const RunOptions& options, const Options& extra) {
    return with_problem<FieldProblem>(
        key.problem, "field", [&]<int Dim>(const FieldProblem<Dim>& problem) {
          return run_seeds<Dim>(problem, key, options, seeds_of(extra));
        });
  };
  return run_study(argc, argv, study);
}
