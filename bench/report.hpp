#pragma once

#include <exception>
#include <string>

#include <benchmark/benchmark.h>

#include "methods/core/error.hpp"
#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Runs the body of a benchmark; what it throws becomes the benchmark's error, and sets `failed`
/// unless the case was skipped for a reason.
template <class Body>
void run_guarded(benchmark::State& state, bool& failed, const Body& body) {
  try {
    body();
  } catch (const SkipCase& skipped) {
    state.SkipWithError(skipped.what());
  } catch (const std::exception& error) {
    failed = true;
    state.SkipWithError(error.what());
  }
}

/// Adds the time per node as a counter, in seconds, and what the benchmark says of itself.
inline void report_per_node(benchmark::State& state, double nodes, const std::string& label) {
  state.counters["per_node"] = benchmark::Counter(
      nodes, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetLabel(label);
}

/// Runs the registered benchmarks that the command line chooses; `failed` tells afterwards whether
/// one did. Returns the exit status.
inline int run_registered(int argc, char** argv, const bool& failed) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("simd", std::string(name_of(simd_path())));
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return failed ? 1 : 0;
}

}  // namespace strongpoint
