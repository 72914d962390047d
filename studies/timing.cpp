#include <fmt/format.h>

#include "problems/core/voronoi.hpp"
#include "studies/support/phases.hpp"
#include "studies/support/run_case.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {
namespace {

struct NamedAlgorithm {
  std::string name;
  PhaseAlgorithm algorithm;
};

/// The algorithms that `--algorithms` asks for.
std::vector<NamedAlgorithm> algorithms_of(const Options& extra) {
  const NamedAlgorithm sort{"sort", PhaseAlgorithm::sort};
  const NamedAlgorithm cells{"cells", PhaseAlgorithm::cells};
  return extra.choice<std::vector<NamedAlgorithm>>(
      "algorithms", {{"both", {sort, cells}}, {"sort", {sort}}, {"cells", {cells}}, {"none", {}}});
}

/// True when a method is one Taylor fit, whose phases the thesis times.
bool is_taylor_fit(const std::string& method) {
  const auto made = make_method<2>(method).made;
  return dynamic_cast<const TaylorMethod<2>*>(made.get()) != nullptr;
}

std::vector<std::string> quantities(const CaseKey& key, const Options& extra) {
  steady_quantities(key);  // skips problems of another kind
  std::vector<std::string> names{"voronoi", "voronoi_share", "total"};
  if (is_iterative(key.solver)) names.emplace_back("iterations");
  if (!is_taylor_fit(key.method)) return names;
  for (std::size_t i = 0; i < algorithms_of(extra).size(); ++i) {
    names.insert(names.end(), phase_names.begin(), phase_names.end());
  }
  return names;
}

/// Appends the phases of one algorithm, the fastest of `repeat` runs each.
template <int Dim>
void append_phases(const SteadyProblem<Dim>& problem, const CaseKey& key, const RunOptions& options,
                   const NamedAlgorithm& algorithm, std::vector<Quantity>& result) {
  const Choices<Dim> choices(key);
  const auto* method = dynamic_cast<const TaylorMethod<Dim>*>(choices.method.get());
  const PointCloud<Dim> cloud = make_case_cloud<Dim>(problem.domain(), key, options);
  Eigen::VectorXd volumes;
  if (method->needs().volumes) {
    volumes = voronoi_volumes<Dim>(cloud, problem.domain(),
                                   *make_search<Dim>(options.neighbours, cloud.nodes));
  }
  std::array<double, phase_names.size()> seconds{};
  for (int run = 0; run < options.repeat; ++run) {
    const auto now = run_phases<Dim>(cloud, volumes, method->kernel(), method->stencil_size(),
                                     algorithm.algorithm)
                         .seconds;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      seconds[i] = run == 0 ? now[i] : std::min(seconds[i], now[i]);
    }
  }
  double sum = 0;
  for (double phase : seconds) sum += phase;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    result.push_back({phase_names[i],
                      seconds[i],
                      {},
                      {algorithm.name, fmt::format("{:.2f}", 100 * seconds[i] / sum), ""}});
  }
}

CaseResult run(const CaseKey& key, const RunOptions& options, const Options& extra) {
  CaseResult result = run_steady_case(key, options);
  const double total = result.times.total();
  const double voronoi = result.times.voronoi;
  result.quantities = {{"voronoi", voronoi, {}, {"", "", ""}},
                       {"voronoi_share", 100 * voronoi / total, {}, {"", "", ""}},
                       {"total", total, {}, {"", "", ""}}};
  if (is_iterative(key.solver)) {
    result.quantities.push_back(
        {"iterations", static_cast<double>(result.iterations), {}, {"", "", result.solver}});
  }
  if (!is_taylor_fit(key.method)) return result;
  for (const NamedAlgorithm& algorithm : algorithms_of(extra)) {
    with_problem<SteadyProblem>(
        key.problem, "steady", [&]<int Dim>(const SteadyProblem<Dim>& problem) {
          append_phases<Dim>(problem, key, options, algorithm, result.quantities);
        });
  }
  return result;
}

}  // namespace
}  // namespace strongpoint

/// Seconds of each stage of a solve, of the Voronoi cells, and of the phases in which the thesis
/// builds its operators.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "timing";
  study.summary = "seconds of each stage, of Voronoi cells and of the thesis' phases";
  study.defaults.problem = "plate_hole";
  study.defaults.method = "mfpm_original,mfpm";
  study.defaults.levels = "81";
  study.timed = true;
  study.rated = false;
  study.extra_columns = {"algorithm", "share", "solved_by"};
  study.variant_columns = {"algorithm", "solved_by"};
  study.extra_options = {
      {"algorithms", "both",
       "both | sort | cells | none: how the instrumented run finds neighbours and "
       "judges conditions (sort: full sort, 1-norm estimate; cells: cells, SVD); it starts from "
       "the "
       "method's own number of nearest nodes and grows to cond(S A) <= 4e8, whatever --stencil "
       "says"}};
  study.check_options = [](const Options& extra) { algorithms_of(extra); };
  study.quantities = quantities;
  study.run = run;
  return run_study(argc, argv, study);
}
