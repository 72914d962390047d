#include <cmath>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <omp.h>

#include "bench/report.hpp"
#include "problems/core/integrator.hpp"
#include "problems/core/problem.hpp"
#include "problems/core/spectrum.hpp"
#include "studies/support/waves.hpp"

extern "C" {
/// Present when UMFPACK's BLAS is OpenBLAS.
void openblas_set_num_threads(int threads) __attribute__((weak));
}

namespace strongpoint {
namespace {

/// A problem of waves and how it is stepped.
struct StepCase {
  std::string name, problem, method, stencil, time, damping;
  int dim;
  int level;
};

/// Times steps of one length, half the time that a wave takes from node to node. Their answer is
/// checked first: the stress in the bar when the pulse has just come in.
template <int Dim>
void time_steps(benchmark::State& state, const StepCase& choice) {
  const AnyProblem made = make_problem(choice.problem).made;
  const auto& problem =
      dynamic_cast<const TransientProblem<Dim>&>(*std::get<std::unique_ptr<Problem<Dim>>>(made));
  const CaseKey key{choice.problem, choice.method, choice.stencil, "grid",
                    "collocation",  "umfpack",     choice.level};
  StageTimes times;
  const Waves<Dim> waves = make_waves<Dim>(problem, key, {}, times);
  const CondensedMotion& motion = *waves.motion;
  const double q = node_time<Dim>(problem, waves, spectral_radius(motion));
  const DampedMotion damped(motion, make_damping(choice.damping), q);
  const LoadHistory load = [&](double t) { return problem.load(t); };
  const auto integrator = make_integrator(choice.time, {damped, load, q / 2});
  MotionState moving;
  moving.displacement = moving.velocity = Eigen::VectorXd::Zero(motion.size());
  integrator->start(moving);
  constexpr double largest_error = 0.1;
  constexpr double pulse_end = 0.6;
  while (static_cast<double>(moving.step) * q / 2 < pulse_end) integrator->advance(moving);
  const double time = static_cast<double>(moving.step) * q / 2;
  const double error = problem.measure(
      solution_of<Dim>(*waves.scene, motion.all_unknowns(moving.displacement, load(time))),
      time)[0];
  if (!(error <= largest_error)) {
    throw CaseError(fmt::format("{}: the stress is off by {:.1e}", choice.name, error));
  }
  for (auto _ : state) {
    integrator->advance(moving);
    benchmark::DoNotOptimize(moving.displacement.data());
  }
  state.counters["error"] = error;
  report_per_node(state, waves.scene->cloud.size(),
                  fmt::format("{} {} {} Dim={} N={} grid", choice.method, choice.stencil,
                              choice.damping, Dim, waves.scene->cloud.size()));
}

int run(int argc, char** argv) {
  bool failed = false;
  omp_set_num_threads(1);
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  const std::string n15 = "nearest[k=15]";
  const std::vector<StepCase> cases{
      {"mfpm9", "bar_2d", "mfpm", "nearest[k=9]", "central", "none", 2, 201},
      {"lsfdm15_hyper", "bar_2d", "lsfdm", n15, "central", "hyper", 2, 201},
      {"lsfdm15_rk4", "bar_2d", "lsfdm", n15, "rk4", "none", 2, 201},
      {"lsfdm15_newmark", "bar_2d", "lsfdm", n15, "newmark", "none", 2, 201},
      {"lsfdm27", "bar_3d", "lsfdm", "nearest[k=27]", "central", "none", 3, 61}};
  for (const StepCase& choice : cases) {
    const std::string name =
        fmt::format("time_step/{}/level:{}/{}d", choice.name, choice.level, choice.dim);
    benchmark::RegisterBenchmark(name.c_str(), [choice, &failed](benchmark::State& state) {
      run_guarded(state, failed, [&] {
        choice.dim == 2 ? time_steps<2>(state, choice) : time_steps<3>(state, choice);
      });
    })->Unit(benchmark::kMicrosecond);
  }
  return run_registered(argc, argv, failed);
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) { return strongpoint::run(argc, argv); }
