#pragma once

#include <optional>
#include <string>
#include <vector>

#include "methods/core/options.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// How a case runs in time.
struct TimeOptions {
  std::string time;             ///< canonical spec of the integrator; empty: central differences
  std::optional<double> t_end;  ///< when the solution is judged; the problem's own if not given
  std::string damping;          ///< canonical spec
};

/// The options of a study that runs problems in time.
std::vector<OptionDoc> time_option_docs();

/// Reads them. Throws UsageError for values that do not fit.
TimeOptions time_options(const Options& extra);

/// Names of the columns that tell how a case ran in time.
std::vector<std::string> time_columns();

/// Names of what a case in time gives. Throws SkipCase when the problem is of another kind.
std::vector<std::string> transient_quantities(const CaseKey& key);

/// Runs a problem of waves from rest, or its initial state, to its end: what the problem measures,
/// then `energy_ratio` (at the end over that at half of the run) and `steps_survived`. A run that
/// grows beyond a thousand times what its loads can cause in a system that does not grow by itself
/// has diverged: its other quantities have no value. Throws SkipCase and CaseError.
CaseResult run_transient_case(const CaseKey& key, const RunOptions& options,
                              const TimeOptions& time);

}  // namespace strongpoint
