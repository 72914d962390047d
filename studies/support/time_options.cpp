#include "studies/support/time_options.hpp"

#include <fmt/format.h>

#include "problems/core/damping.hpp"
#include "problems/core/integrator.hpp"
#include "problems/core/transient_problem.hpp"
#include "studies/support/output.hpp"
#include "studies/support/run_case.hpp"

namespace strongpoint {
namespace {

std::string text_of(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

}  // namespace

std::vector<OptionDoc> time_option_docs() {
  return {
      {"time", "", "problems in time: how steps are taken, as central[dt=1e-3]"},
      {"t-end", "", "problems in time: when they end; if not given, the problem's own end"},
      {"damping", "none", "problems in time: none, stiffness[eta=0.02], hyper[g=0.02]"},
      {"noise", "", "problems in time: measure growth_rate by noise that runs so long"},
      {"frames", "1", "problems in time: instants that --vtk writes, equally spaced to the end"},
      {"checkpoint", "",
       "problems in time: directory for states of runs under way, from which killed ones go on"},
      {"checkpoint-every", "5", "seconds between two states saved"}};
}

TimeOptions time_options(const Options& extra) {
  TimeOptions options;
  if (extra.has("time")) options.time = parse_time(extra.text("time")).spec;
  if (extra.has("t-end")) options.t_end = extra.number("t-end", 1e-9, 1e9);
  options.damping = canonical_damping(extra.text("damping"));
  if (extra.has("noise")) options.noise = extra.number("noise", 1e-9, 1e9);
  options.frames = extra.integer("frames", 1, 2000);
  if (extra.has("checkpoint")) options.checkpoints = extra.text("checkpoint");
  options.checkpoint_seconds = extra.number("checkpoint-every", 0, 1e6);
  return options;
}

void prepare_time(const Options& extra, const RunOptions& run) {
  const TimeOptions options = time_options(extra);
  if (options.frames > 1 && !run.vtk) {
    throw UsageError(fmt::format(
        "--frames {}: frames are files of --vtk DIR, which is not given; add it", options.frames));
  }
  if (!options.checkpoints.empty()) make_directory("--checkpoint", options.checkpoints);
}

std::vector<std::string> time_columns() {
  return {"time", "t_end", "damping", "dt", "steps", "noise"};
}

bool keeps_time(const CaseKey& key, const std::vector<std::string>& columns, const Options& extra) {
  if (!is_kind<TransientProblem>(key.problem)) return true;
  const TimeOptions options = time_options(extra);
  const double end = with_problem<TransientProblem>(
      key.problem, "transient",
      [&](const auto& problem) { return options.t_end.value_or(problem.end_time()); });
  return columns[0] == options.integrator() && columns[1] == text_of(end) &&
         columns[2] == options.damping && columns[5] == text_of(options.noise);
}

}  // namespace strongpoint
