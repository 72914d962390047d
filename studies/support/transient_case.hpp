#pragma once

#include <string>
#include <vector>

#include "studies/support/study.hpp"
#include "studies/support/time_options.hpp"

namespace strongpoint {

/// Names of what a case in time gives. Throws SkipCase when the problem is of another kind.
std::vector<std::string> transient_quantities(const CaseKey& key);

/// Those of all cases in time that are no errors, and have no rate of convergence.
std::vector<std::string> unrated_quantities();

/// Runs a problem of waves from rest, or its initial state, to its end: what the problem measures,
/// then `energy_ratio` (at the end over that at half of the run), `growth_rate` (of noise, as
/// `noise_growth` measures it, where that is asked for) and `steps_survived`. A run whose
/// velocities grow beyond ten times what its loads can cause in a system that does not grow by
/// itself has diverged: the quantities of its end have no value. With `options.vtk` instants are
/// written, with checkpoints the state now and then; these are removed at the end of the case.
/// Times are those of the run without its noise and files, since it was last started. Throws
/// SkipCase and CaseError.
CaseResult run_transient_case(const CaseKey& key, const RunOptions& options,
                              const TimeOptions& time);

}  // namespace strongpoint
