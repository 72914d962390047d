#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "studies/support/derivative_errors.hpp"
#include "studies/support/stencil_quality.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {
namespace {

/// The rules that the limits of `grow_until` are tried on: the thesis' first and second searching
/// algorithm (6.3.3).
constexpr std::array<const char*, 2> grown{"nearest[k=9]", "nearest[k=15]"};
/// The rules without a limit: the thesis' third searching algorithm (6.3.3), the star and the fixed
/// support of 3.2.1, and what the first two start from.
constexpr std::array<const char*, 5> plain{"block", "star", "radius", "nearest[k=9]",
                                           "nearest[k=15]"};

/// A grow_until rule with one value of each option. Throws UsageError naming the options.
std::string grow_until(const std::string& limit, const std::string& scaling,
                       const std::string& norm, const char* base) {
  std::string spec =
      fmt::format("grow_until[cond_max={},scaling={},norm={},of={}]", limit, scaling, norm, base);
  try {
    return make_rule<2>(spec).spec;
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("--cond-max '{}' --scaling '{}' --norm '{}': {}", limit, scaling,
                                 norm, error.what()));
  }
}

/// The values of an option, with commas between them.
std::vector<std::string> values_of(const Options& extra, const std::string& key) {
  try {
    return split_specs(extra.text(key));
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("--{} {}: {}", key, extra.text(key), error.what()));
  }
}

/// Every grow_until rule over the limits, scalings and norms asked for, then the plain rules.
std::string default_stencils(const Options& extra) {
  std::string axis;
  for (const char* base : grown) {
    for (const std::string& scaling : values_of(extra, "scaling")) {
      for (const std::string& norm : values_of(extra, "norm")) {
        for (const std::string& limit : values_of(extra, "cond-max")) {
          axis += grow_until(limit, scaling, norm, base) + ",";
        }
      }
    }
  }
  return fmt::format("{}{}", axis, fmt::join(plain, ","));
}

/// What the errors of a case are called: of the solution of a steady problem, of each derivative of
/// a field. Throws SkipCase for other problems.
std::vector<std::string> error_names(const CaseKey& key) {
  return with_problem<Problem>(
      key.problem, "registered", [&]<int Dim>(const Problem<Dim>& problem) {
        const auto* field = dynamic_cast<const FieldProblem<Dim>*>(&problem);
        if (field == nullptr) return steady_quantities(key);
        return derivative_error_names<Dim>(*field, *make_method<Dim>(key.method).made);
      });
}

std::vector<std::string> quantities(const CaseKey& key, const Options&) {
  std::vector<std::string> names{"size_min",         "size_mean",     "size_max",
                                 "condition_median", "condition_max", "over_limit"};
  const std::vector<std::string> errors = error_names(key);
  names.insert(names.end(), errors.begin(), errors.end());
  return names;
}

/// The numbers of the wanted anchors.
template <int Dim>
std::vector<double> wanted(const Discretisation<Dim>& scene, const PerAnchor& figure) {
  std::vector<double> numbers;
  for (int a : scene.sites.wanted_anchors()) numbers.push_back(figure.values[a]);
  return numbers;
}

template <int Dim>
void append_sizes(const Discretisation<Dim>& scene, const Method<Dim>& method,
                  std::vector<Quantity>& result) {
  const std::vector<double> sizes = wanted(scene, stencil_sizes<Dim>(scene, method));
  const Spread spread = spread_of(sizes);
  const double sum = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  result.push_back({"size_min", spread.least, {}, {}});
  result.push_back({"size_mean", sum / static_cast<double>(sizes.size()), {}, {}});
  result.push_back({"size_max", spread.most, {}, {}});
}

/// Conditions by the same yardstick for every rule: the 2-norm, both sides scaled.
template <int Dim>
void append_conditions(const Discretisation<Dim>& scene, const Method<Dim>& method,
                       std::vector<Quantity>& result) {
  const PerAnchor figure =
      stencil_conditions<Dim>(scene, method, Scaling::both, ConditionNorm::two);
  const Spread spread = figure.reason.empty() ? spread_of(wanted(scene, figure)) : Spread{};
  for (const auto& [name, value] :
       {std::pair{"condition_median", spread.median}, std::pair{"condition_max", spread.most}}) {
    if (!figure.reason.empty()) {
      result.push_back({name, {}, figure.reason, {}});
    } else if (std::isinf(value)) {
      result.push_back({name, {}, "infinite: a local matrix is singular, or there is none", {}});
    } else {
      result.push_back({name, value, {}, {}});
    }
  }
}

/// How many stencils a growing rule gave up on: their condition, scaled and measured as the rule
/// does it, is still above its limit.
template <int Dim>
Quantity over_limit(const Discretisation<Dim>& scene, const Method<Dim>& method,
                    const std::string& stencil) {
  Quantity quantity{"over_limit", {}, "the rule sets no limit to the condition", {}};
  for (const Zone zone : {Zone::interior, Zone::boundary}) {
    const std::optional<ConditionLimit> limit = condition_limit(stencil, zone);
    if (!limit) continue;
    const PerAnchor figure = stencil_conditions<Dim>(scene, method, limit->scaling, limit->norm);
    if (!figure.reason.empty()) return {"over_limit", {}, figure.reason, {}};
    double count = quantity.value.value_or(0);
    for (int a : scene.sites.wanted_anchors()) {
      if (scene.sites.anchor_zone[a] == zone && !(figure.values[a] <= limit->most)) ++count;
    }
    quantity = {"over_limit", count, {}, {}};
  }
  return quantity;
}

/// Puts what is known of the stencils before the errors.
template <int Dim>
void prepend_stencils(const Discretisation<Dim>& scene, const CaseKey& key, CaseResult& result) {
  const std::unique_ptr<Method<Dim>> method = make_method<Dim>(key.method).made;
  std::vector<Quantity> stencils;
  append_sizes<Dim>(scene, *method, stencils);
  append_conditions<Dim>(scene, *method, stencils);
  stencils.push_back(over_limit<Dim>(scene, *method, key.stencil));
  result.quantities.insert(result.quantities.begin(), stencils.begin(), stencils.end());
}

/// The stencils that the equations of a steady problem read, and the error of its solution.
template <int Dim>
CaseResult run(const SteadyProblem<Dim>& problem, const CaseKey& key, const RunOptions& options) {
  CaseResult result = run_steady_case(key, options);
  StageTimes untold;
  const auto made = discretise<Dim>(problem, key, options, untold, Upto::stencils);
  const Discretisation<Dim>& scene = *made;
  prepend_stencils<Dim>(scene, key, result);
  return result;
}

/// The stencils at every node, and the errors of the derivatives of a field.
template <int Dim>
CaseResult run(const FieldProblem<Dim>& problem, const CaseKey& key, const RunOptions& options) {
  CaseResult result;
  Discretisation<Dim> scene;
  for (int run = 0; run < options.repeat; ++run) {
    StageTimes times;
    reset_peak_memory();
    scene = discretise_field<Dim>(problem, key, options, times);
    times.peak_mb = peak_memory_mb();
    result.times = run == 0 ? times : fastest(result.times, times);
  }
  result.quantities = derivative_errors<Dim>(problem, key, options, scene);
  result.nodes = scene.cloud.size();
  result.spacing = scene.cloud.spacing();
  prepend_stencils<Dim>(scene, key, result);
  return result;
}

CaseResult run_case(const CaseKey& key, const RunOptions& options, const Options&) {
  return with_problem<Problem>(
      key.problem, "registered", [&]<int Dim>(const Problem<Dim>& problem) {
        if (const auto* field = dynamic_cast<const FieldProblem<Dim>*>(&problem)) {
          return run<Dim>(*field, key, options);
        }
        return with_problem<SteadyProblem>(
            key.problem, "steady", [&](const auto& steady) { return run(steady, key, options); });
      });
}

}  // namespace
}  // namespace strongpoint

/// Stencil rules against each other on the same cloud: how large and how well conditioned the
/// stencils are that are read, what they cost, and the error that comes of them: of the solution of
/// a steady problem, or of each derivative of a field.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "selection";
  study.summary = "stencil rules against each other: sizes, conditions, errors, times";
  study.defaults.problem = "plate_hole";
  study.defaults.method = "mfpm";
  study.defaults.levels = "41";
  study.timed = true;
  study.rated = false;
  study.mapped = true;
  study.extra_options = {
      {"cond-max", "1e2,1e3,1e4,1e6,4e8,1e9", "limits of the grow_until rules compared"},
      {"scaling", "both,row", "their scalings of the local matrix"},
      {"norm", "two", "their norms of the condition: two, one or both of them"}};
  study.default_stencils = default_stencils;
  study.quantities = quantities;
  study.run = run_case;
  return run_study(argc, argv, study);
}
