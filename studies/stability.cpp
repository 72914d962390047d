#include <fmt/format.h>

#include "studies/support/seeds.hpp"
#include "studies/support/stability_case.hpp"

namespace strongpoint {
namespace {

StabilityOptions stability_options(const Options& extra) {
  return {extra.integer("seeds", 1, 1000), extra.number("t-end", 1e-3, 1e6),
          extra.number("tolerance", 0, 1e6)};
}

}  // namespace
}  // namespace strongpoint

/// Stability of waves, by the spectrum of the condensed operator: growth without damping, what
/// damping it takes to stop it, stable steps, and how long noise stays bounded.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "stability";
  study.summary = "growth of waves, the damping that stops it, and stable steps";
  study.defaults.problem = "bar_2d";
  study.defaults.method = "mfpm,mfpm_original,gfdm,lsfdm";
  study.defaults.cloud = "grid,grid[stretch=3],perturbed,scattered";
  study.defaults.levels = "31";
  study.defaults.smoke_levels = "11";
  study.rated = false;
  study.extra_columns = {"seeds", "low", "high", "t_end", "tolerance"};
  study.extra_options = {
      {"seeds", "3",
       "clouds of consecutive seeds that a case with random nodes is run on, 1 to 1000: value is "
       "the worst, low and high are the smallest and largest"},
      {"t-end", "30", "how long noise is watched"},
      {"tolerance", "0.01", "growth rate that counts as none, 1 over time"}};
  study.check_options = [](const Options& extra) { stability_options(extra); };
  study.keeps = [](const CaseKey& key, const std::vector<std::string>& columns,
                   const Options& extra) {
    if (columns[0].empty()) return true;  // a skipped case, whatever the seeds
    const StabilityOptions wanted = stability_options(extra);
    return columns[0] == fmt::format("{}", with_seeds(key.cloud, 1, wanted.seeds).size()) &&
           columns[3] == fmt::format("{}", wanted.t_end) &&
           columns[4] == fmt::format("{}", wanted.tolerance);
  };
  study.quantities = [](const CaseKey& key, const Options& extra) {
    return stability_quantities(key, stability_options(extra));
  };
  study.run = [](const CaseKey& key, const RunOptions& options, const Options& extra) {
    return run_stability_case(key, options, stability_options(extra));
  };
  return run_study(argc, argv, study);
}
