#pragma once

#include <algorithm>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bench/report.hpp"

namespace strongpoint {

/// A figure that the project sets itself: how many times faster than a rival.
struct Goal {
  std::string name;    ///< "knn/2d/uniform"
  std::string rival;   ///< what it is measured against
  double ratio = 1;    ///< rival's time over ours that has to be reached
  double stretch = 0;  ///< the one that is hoped for, 0 for none
};

/// Two ways to the same answer, which have been compared before they are timed.
struct Contest {
  std::function<void()> subject;  ///< ours
  std::function<void()> rival;
  double nodes = 1;   ///< that each run treats
  std::string label;  ///< cloud, seed, sizes
  int repeats = 7;    ///< runs of each at least
};

/// Seconds that are filled with runs: what else the machine does slows few of many.
inline constexpr double least_seconds = 3;

/// CPU seconds of the process that a call takes.
inline double cpu_seconds(const std::function<void()>& call) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double begin = now();
  call();
  return now() - begin;
}

/// Runs subject and rival alternately and reports the least time of each, in seconds a node, and
/// their ratio beside the goal.
inline void time_contest(benchmark::State& state, const Goal& goal, const Contest& contest) {
  double subject = std::numeric_limits<double>::infinity();
  double rival = subject;
  for (auto _ : state) {
    double spent = 0;
    for (int run = 0; run < contest.repeats || spent < least_seconds; ++run) {
      const double theirs = cpu_seconds(contest.rival);
      const double ours = cpu_seconds(contest.subject);
      rival = std::min(rival, theirs);
      subject = std::min(subject, ours);
      spent += theirs + ours;
    }
    state.SetIterationTime(subject);
  }
  state.counters["subject"] = subject / contest.nodes;
  state.counters["rival"] = rival / contest.nodes;
  state.counters["ratio"] = rival / subject;
  state.counters["goal"] = goal.ratio;
  state.counters["stretch"] = goal.stretch;
  state.SetLabel(fmt::format("against {}; {}", goal.rival, contest.label));
}

/// Registers the benchmark "goal/NAME". `prepare` makes the contest and throws CaseError when the
/// answers of the two differ; what it throws becomes the benchmark's error and sets `failed`.
template <class Prepare>
void add_goal(const Goal& goal, bool& failed, Prepare prepare) {
  benchmark::RegisterBenchmark(
      ("goal/" + goal.name).c_str(),
      [goal, &failed, prepare = std::move(prepare)](benchmark::State& state) {
        run_guarded(state, failed, [&] { time_contest(state, goal, prepare()); });
      })
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace strongpoint
