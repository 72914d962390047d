#include "studies/support/march.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "studies/support/case_monitor.hpp"
#include "studies/support/output.hpp"

namespace strongpoint {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

void note(CaseMonitor* monitor, const std::string& line) {
  if (monitor != nullptr && monitor->note) monitor->note(line);
}

void continue_from_checkpoint(MotionState& state, const March& march, CaseMonitor* monitor) {
  if (!march.saving) return;
  const Checkpoint& checkpoint = march.saving->checkpoint;
  switch (checkpoint.load(state, march.memory)) {
    case Checkpoint::Found::nothing:
      return;
    case Checkpoint::Found::other_version:
      note(monitor, fmt::format("{}: was left by another version of the code; starts anew",
                                checkpoint.path()));
      return;
    case Checkpoint::Found::state:
      note(monitor, fmt::format("{}: continues after step {} of {}", checkpoint.path(), state.step,
                                march.steps));
  }
}

}  // namespace

Steps steps_until(double end, double longest, const std::string& spec) {
  constexpr double most = 1e12;
  constexpr double slack = 1e-6;  // a quotient that is nearly a whole number is one
  const double count = std::max(1.0, std::ceil(end / longest - slack));
  if (!(count <= most)) {
    throw CaseError(
        fmt::format("{:.3g} steps of {:.3g} up to the time {:.3g} are too many; take a "
                    "longer step or an earlier end",
                    count, longest, end));
  }
  return {spec, end / count, end, static_cast<std::int64_t>(count), longest};
}

std::string save_state(const MotionState& state, const March& march) {
  if (!march.saving) return {};
  try {
    march.saving->checkpoint.save(state, march.memory);
    return {};
  } catch (const WriteError& error) {
    return error.what();
  }
}

void march(MotionState& state, const March& march, CaseMonitor* monitor) {
  constexpr double seconds_shown = 0.2;
  continue_from_checkpoint(state, march, monitor);
  SaveRequest::Server server(march.saving && monitor != nullptr ? &monitor->save : nullptr);
  const bool shows = monitor != nullptr && monitor->show;
  bool told = false;
  Clock::time_point saved = Clock::now();
  Clock::time_point shown = saved;
  while (state.step < march.steps) {
    march.integrator.advance(state);
    if (!march.after(state)) return;
    const bool asked = server.is_asked();
    if (asked || (march.saving && seconds_since(saved) >= march.saving->seconds)) {
      const std::string trouble = save_state(state, march);
      if (!trouble.empty() && !told) {
        note(monitor, trouble + "; the run goes on, but if it is killed it is lost");
        told = true;
      }
      saved = Clock::now();
    }
    if (asked) server.done();
    if (shows && seconds_since(shown) >= seconds_shown) {
      monitor->show(march.earlier + state.step, march.earlier + march.steps + march.later);
      shown = Clock::now();
    }
  }
}

}  // namespace strongpoint
