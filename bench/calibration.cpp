#include "studies/support/calibration.hpp"

#include <benchmark/benchmark.h>

#include "bench/report.hpp"

namespace strongpoint {
namespace {

int run(int argc, char** argv) {
  bool failed = false;
  benchmark::RegisterBenchmark("calibration",
                               [&failed](benchmark::State& state) {
                                 run_guarded(state, failed, [&] {
                                   Calibration figures{};
                                   for (auto _ : state) figures = calibrate();
                                   state.counters["copy_gigabytes_per_second"] =
                                       figures.copy_gigabytes_per_second;
                                   state.counters["factor_seconds"] = figures.factor_seconds;
                                 });
                               })
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
  return run_registered(argc, argv, failed);
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) { return strongpoint::run(argc, argv); }
