#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <omp.h>

#include "bench/elastic_system.hpp"
#include "bench/report.hpp"

extern "C" {
/// Present when UMFPACK's BLAS is OpenBLAS.
void openblas_set_num_threads(int threads) __attribute__((weak));
}

namespace strongpoint {
namespace {

/// A system and how it is solved.
struct SolveCase {
  std::string solver;
  int dim;
  ElasticChoices choices;
};

KnownSystem assembled(const SolveCase& choice) {
  return choice.dim == 2 ? ElasticSystem<2>(choice.choices).assembled()
                         : ElasticSystem<3>(choice.choices).assembled();
}

/// Times a solve of an elastic square or cube with tractions, ordering and factorisation included.
void time_solve(benchmark::State& state, const SolveCase& choice) {
  // A residual of 1e-9 in the smallest rows, times the condition.
  constexpr double largest_error = 1e-5;
  const KnownSystem known = assembled(choice);
  const LinearSolution checked = solve(known.system, choice.solver);
  const double error = (checked.x - known.solution).lpNorm<Eigen::Infinity>() /
                       known.solution.lpNorm<Eigen::Infinity>();
  if (!(error <= largest_error)) {
    throw CaseError(fmt::format("{}: the solution is off by {:.1e}", choice.solver, error));
  }
  for (auto _ : state) benchmark::DoNotOptimize(solve(known.system, choice.solver).x.data());
  state.counters["iterations"] = checked.iterations;
  state.counters["error"] = error;
  report_per_node(
      state, static_cast<double>(known.system.unknowns()) / choice.dim,
      fmt::format("{} {} Dim={} unknowns={} perturbed[amount=0.2,seed=1]", choice.choices.method,
                  choice.choices.stencil, choice.dim, known.system.unknowns()));
}

int run(int argc, char** argv) {
  bool failed = false;
  omp_set_num_threads(1);
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  const ElasticChoices second_order{.level = 16};
  ElasticChoices square = second_order;
  square.level = 81;
  square.stencil = "nearest[k=15]";
  ElasticChoices large = second_order;
  large.level = 31;
  const std::vector<SolveCase> cases{{"umfpack", 2, square},
                                     {"bicgstab", 2, square},
                                     {"umfpack", 3, second_order},
                                     {"bicgstab", 3, second_order},
                                     {"bicgstab", 3, large}};
  for (const SolveCase& choice : cases) {
    const std::string name =
        fmt::format("solve/{}/level:{}/{}d", choice.solver, choice.choices.level, choice.dim);
    benchmark::RegisterBenchmark(name.c_str(), [choice, &failed](benchmark::State& state) {
      run_guarded(state, failed, [&] { time_solve(state, choice); });
    })->Unit(benchmark::kMillisecond);
  }
  return run_registered(argc, argv, failed);
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) { return strongpoint::run(argc, argv); }
