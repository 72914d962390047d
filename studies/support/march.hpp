#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "problems/core/integrator.hpp"
#include "studies/support/checkpoint.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// The steps of a run in time, all of one length, the last of which ends at `end`.
struct Steps {
  std::string spec;  ///< of the integrator
  double dt = 0, end = 0;
  std::int64_t count = 0;
  double longest = 0;  ///< what `dt` was to be at most

  /// Time at the end of a step.
  double time(std::int64_t step) const {
    return step == count ? end : static_cast<double>(step) * dt;
  }
};

/// The steps of an integrator up to a time, each as long as `longest` or a little shorter. Throws
/// CaseError when they are too many.
Steps steps_until(double end, double longest, const std::string& spec);

/// A file from which a run continues, and how often it is written.
struct Saving {
  Checkpoint checkpoint;
  double seconds;  ///< of wall time between two states saved
};

/// A run of steps that may be killed and continued.
struct March {
  Integrator& integrator;
  std::int64_t steps;
  /// Looks at the state after each step; false ends the run.
  std::function<bool(MotionState&)> after;
  std::span<std::byte> memory;   ///< what `after` remembers from step to step
  std::optional<Saving> saving;  ///< none: a run that is killed is lost
  std::int64_t earlier = 0;      ///< steps of other runs of the case before this one
  std::int64_t later = 0;        ///< and after it
};

/// Takes a state, started, to the last step or until `after` ends the run. Where a checkpoint was
/// left by a run that was killed it continues from there, to the same bits; a disk that is full
/// does not end it. Throws CaseError for a checkpoint that is damaged or of another run.
void march(MotionState& state, const March& march, CaseMonitor* monitor);

/// Saves a state if that is wanted. Returns why it could not be written, or nothing.
std::string save_state(const MotionState& state, const March& march);

}  // namespace strongpoint
