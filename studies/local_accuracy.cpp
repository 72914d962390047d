#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "studies/support/derivative_errors.hpp"
#include "studies/support/seeds.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {
namespace {

int seeds_of(const Options& extra) { return extra.integer("seeds", 1, 1000); }

std::vector<std::string> quantities(const CaseKey& key, const Options& extra) {
  with_seeds(key.cloud, 1, seeds_of(extra));  // refuses seeds that are too large
  return with_problem<FieldProblem>(
      key.problem, "field", [&]<int Dim>(const FieldProblem<Dim>& problem) {
        return derivative_error_names<Dim>(problem, *make_method<Dim>(key.method).made);
      });
}

template <int Dim>
CaseResult run(const FieldProblem<Dim>& problem, const CaseKey& key, const RunOptions& options) {
  CaseResult result;
  const Discretisation<Dim> scene = discretise_field<Dim>(problem, key, options, result.times);
  result.quantities = derivative_errors<Dim>(problem, key, options, scene);
  result.nodes = scene.cloud.size();
  result.spacing = scene.cloud.spacing();
  return result;
}

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
  study.check_options = [](const Options& extra) { seeds_of(extra); };
  study.keeps = [](const CaseKey& key, const std::vector<std::string>& columns,
                   const Options& extra) {
    if (columns[0].empty()) return true;  // a skipped case, whatever the seeds
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
