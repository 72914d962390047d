#include <cmath>

#include <fmt/format.h>

#include "problems/core/assembly.hpp"
#include "studies/support/exponents.hpp"
#include "studies/support/run_case.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {
namespace {

/// A stage whose time is a row of its own.
struct Stage {
  const char* name;
  double StageTimes::*seconds;
};
constexpr Stage stages[] = {{"cloud", &StageTimes::cloud},
                            {"prepare", &StageTimes::prepare},
                            {"neighbours", &StageTimes::neighbours},
                            {"stencils", &StageTimes::stencils},
                            {"weights", &StageTimes::weights},
                            {"assemble", &StageTimes::assemble},
                            {"solve", &StageTimes::solve}};

/// The last stage that `--upto` asks for, as a position in `stages`.
int last_stage(const Options& extra) {
  return extra.choice<int>("upto",
                           {{"stencils", 3}, {"weights", 4}, {"assemble", 5}, {"solve", 6}});
}

std::vector<std::string> quantities(const CaseKey& key, const Options& extra) {
  steady_quantities(key);  // skips problems of another kind
  std::vector<std::string> names;
  for (int i = 0; i <= last_stage(extra); ++i) names.emplace_back(stages[i].name);
  names.emplace_back("total");
  names.emplace_back("memory");
  return names;
}

/// Everything before the solve, or up to an earlier stage.
template <int Dim>
CaseResult run_without_solve(const SteadyProblem<Dim>& problem, const CaseKey& key,
                             const RunOptions& options, int last) {
  CaseResult result;
  reset_peak_memory();
  const auto scene = discretise<Dim>(problem, key, options, result.times,
                                     last > 3 ? Upto::weights : Upto::stencils);
  const int fields = static_cast<int>(problem.fields().size());
  if (last > 4) {
    const StageClock clock(options.threads);
    clock.time(result.times.assemble, [&] {
      return assemble(scene->equations(scene->derivatives), scene->weights, scene->unknowns,
                      fields);
    });
  }
  result.times.peak_mb = peak_memory_mb();
  result.nodes = scene->cloud.size();
  result.unknowns = static_cast<std::int64_t>(scene->unknowns.count) * fields;
  result.spacing = scene->cloud.spacing();
  return result;
}

CaseResult run_once(const CaseKey& key, const RunOptions& options, int last) {
  if (last == 6) return run_steady_case(key, options);
  return with_problem<SteadyProblem>(key.problem, "steady",
                                     [&]<int Dim>(const SteadyProblem<Dim>& problem) {
                                       return run_without_solve<Dim>(problem, key, options, last);
                                     });
}

CaseResult run(const CaseKey& key, const RunOptions& options, const Options& extra) {
  const int last = last_stage(extra);
  RunOptions once = options;
  once.repeat = 1;
  CaseResult result = run_once(key, once, last);
  for (int again = 1; again < options.repeat; ++again) {
    result.times = fastest(result.times, run_once(key, once, last).times);
  }
  const double nodes = static_cast<double>(result.nodes);
  const auto add = [&](const char* name, double value, double unit) {
    result.quantities.push_back(
        {name, value, {}, {fmt::format("{:.4g}", value * unit / nodes), ""}});
  };
  result.quantities.clear();
  for (int i = 0; i <= last; ++i) add(stages[i].name, result.times.*stages[i].seconds, 1e6);
  add("total", result.times.total(), 1e6);
  add("memory", result.times.peak_mb, 1e6);
  return result;
}

/// About 1e3 to 1e6 nodes of a square, with `--large` 1e7.
std::string levels_of(const Options& extra) {
  return std::string("32,100,317,1000") + (extra.text("large") == flag_on ? ",3163" : "");
}

}  // namespace
}  // namespace strongpoint

/// Time and memory of each stage against the number of nodes, with fitted exponents.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "scaling";
  study.summary = "seconds of each stage and memory (MB) against the number of nodes";
  study.defaults.problem = "poisson_square";
  study.defaults.method = "lsfdm";
  study.defaults.cloud = "perturbed";
  study.timed = true;
  study.rated = false;
  study.extra_columns = {"per_node", "exponent"};
  study.extra_options = {
      {"upto", "solve", "stencils | weights | assemble | solve: the last stage that is run"},
      {"large", flag_off, "adds 1e7 nodes to the default levels; with --upto assemble"}};
  study.check_options = [](const Options& extra) { last_stage(extra); };
  study.default_levels = levels_of;
  study.quantities = quantities;
  study.run = run;
  study.conclude = [](std::vector<std::vector<Row>>& cases) { fit_exponents(cases, 1); };
  study.appendix = exponents_text;
  return run_study(argc, argv, study);
}
