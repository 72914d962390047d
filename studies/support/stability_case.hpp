#pragma once

#include <string>
#include <vector>

#include "studies/support/study.hpp"

namespace strongpoint {

/// How a case of the study of stability is judged.
struct StabilityOptions {
  int seeds = 3;            ///< clouds of consecutive seeds
  double t_end = 30;        ///< how long noise is watched
  double tolerance = 0.01;  ///< growth that counts as none, 1 over time
};

/// Names of what a case gives, in order. Throws SkipCase unless its problem is one of waves,
/// UsageError when a seed would be too large.
std::vector<std::string> stability_quantities(const CaseKey& key, const StabilityOptions& options);

/// Judges one case of waves by the dense spectrum of its condensed operator and by steps from
/// noise, on clouds of several seeds: of each quantity the worst, with the extra texts {number of
/// clouds, smallest, largest, t_end, tolerance}. Hyperviscosity is taken half as strong again as it
/// must be, a step half as long as it may be. `verdict` is 0 where nothing has to be damped, 1
/// where hyperviscosity keeps noise bounded, 2 where it does not or would need g > 0.5. No value
/// where one of the clouds has none: `reason` says how many, and why. Throws SkipCase, also for
/// more than 2500 unknowns that move, and CaseError when no cloud can be computed.
CaseResult run_stability_case(const CaseKey& key, const RunOptions& options,
                              const StabilityOptions& stability);

}  // namespace strongpoint
