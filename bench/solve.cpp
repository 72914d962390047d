#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <omp.h>
#include <umfpack.h>

#include "bench/elastic_system.hpp"
#include "bench/goal.hpp"
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

/// The error of a solution. Throws CaseError when it is too large.
double checked_error(const KnownSystem& known, const LinearSolution& found,
                     const std::string& solver) {
  // A residual of 1e-9 in the smallest rows, times the condition.
  constexpr double largest_error = 1e-5;
  const double error = (found.x - known.solution).lpNorm<Eigen::Infinity>() /
                       known.solution.lpNorm<Eigen::Infinity>();
  if (!(error <= largest_error)) {
    throw CaseError(fmt::format("{}: the solution is off by {:.1e}", solver, error));
  }
  return error;
}

/// Times a solve of an elastic square or cube with tractions, ordering and factorisation included.
void time_solve(benchmark::State& state, const SolveCase& choice) {
  const KnownSystem known = assembled(choice);
  const LinearSolution checked = solve(known.system, choice.solver);
  const double error = checked_error(known, checked, choice.solver);
  for (auto _ : state) benchmark::DoNotOptimize(solve(known.system, choice.solver).x.data());
  state.counters["iterations"] = checked.iterations;
  state.counters["error"] = error;
  state.counters["solver_mb"] = 1e-6 * static_cast<double>(checked.bytes);
  report_per_node(
      state, static_cast<double>(known.system.unknowns()) / choice.dim,
      fmt::format("{} {} Dim={} unknowns={} perturbed[amount=0.2,seed=1]", choice.choices.method,
                  choice.choices.stencil, choice.dim, known.system.unknowns()));
}

/// UMFPACK as it is used without a thought: its defaults throughout, 64-bit indices.
LinearSolution solve_by_default(const LinearSystem& system) {
  static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));
  const auto* offsets = reinterpret_cast<const SuiteSparse_long*>(system.offsets.data());
  const auto* columns = reinterpret_cast<const SuiteSparse_long*>(system.columns.data());
  const double* values = system.values.data();
  double info[UMFPACK_INFO] = {};
  void* symbolic = nullptr;
  void* numeric = nullptr;
  LinearSolution solution;
  solution.x.resize(system.rows());
  umfpack_dl_symbolic(system.rows(), system.rows(), offsets, columns, values, &symbolic, nullptr,
                      info);
  umfpack_dl_numeric(offsets, columns, values, symbolic, &numeric, nullptr, info);
  solution.bytes = static_cast<std::size_t>(info[UMFPACK_PEAK_MEMORY] * info[UMFPACK_SIZE_OF_UNIT]);
  umfpack_dl_solve(UMFPACK_At, offsets, columns, values, solution.x.data(),
                   system.right_hand_side.data(), numeric, nullptr, nullptr);
  umfpack_dl_free_symbolic(&symbolic);
  umfpack_dl_free_numeric(&numeric);
  return solution;
}

/// A solver against a rival on one elastic system, in time and in memory.
struct SolveGoal {
  SolveCase subject;
  Goal time;
  double memory = 1;  ///< rival's memory over ours that has to be reached, 0 for no such goal
  std::function<LinearSolution(const LinearSystem&)> rival;
  int repeats = 3;
};

/// What both count: UMFPACK's peak, MUMPS' INFOG(21), our matrix of blocks with preconditioner.
void compare_memory(benchmark::State& state, const SolveGoal& goal) {
  const KnownSystem known = assembled(goal.subject);
  const LinearSolution ours = solve(known.system, goal.subject.solver);
  const LinearSolution rival = goal.rival(known.system);
  checked_error(known, ours, goal.subject.solver);
  for (auto _ : state) state.SetIterationTime(1);
  state.counters["subject"] = static_cast<double>(ours.bytes);
  state.counters["rival"] = static_cast<double>(rival.bytes);
  state.counters["ratio"] = static_cast<double>(rival.bytes) / static_cast<double>(ours.bytes);
  state.counters["goal"] = goal.memory;
  state.counters["stretch"] = 0;
  state.SetLabel(fmt::format("against {}; bytes that both count, {} {}", goal.time.rival,
                             goal.subject.solver, ours.solver));
}

/// Registers the goals of time and memory.
void add_solve_goal(const SolveGoal& goal, bool& failed) {
  add_goal(goal.time, failed, [goal] {
    const auto known = std::make_shared<const KnownSystem>(assembled(goal.subject));
    const LinearSolution checked = solve(known->system, goal.subject.solver);
    checked_error(*known, checked, goal.subject.solver);
    checked_error(*known, goal.rival(known->system), goal.time.rival);
    const double nodes = static_cast<double>(known->system.unknowns()) / goal.subject.dim;
    return Contest{
        [known, goal] { solve(known->system, goal.subject.solver); },
        [known, goal] { goal.rival(known->system); }, nodes,
        fmt::format("{} {}, {} unknowns, perturbed[amount=0.2,seed=1], tractions on ghosts",
                    goal.subject.solver, checked.solver, known->system.unknowns()),
        goal.repeats};
  });
  if (goal.memory == 0) return;
  benchmark::RegisterBenchmark(("goal/" + goal.time.name + "/memory").c_str(),
                               [goal, &failed](benchmark::State& state) {
                                 run_guarded(state, failed, [&] { compare_memory(state, goal); });
                               })
      ->Iterations(1)
      ->UseManualTime();
}

/// The goals: squares of 321^2 nodes and, with wide stencils, 41^2, the cube of 31^3; tractions on
/// the upper faces.
void add_goals(bool& failed) {
  ElasticChoices square{.level = 321};
  square.stencil = "nearest[k=15]";
  add_solve_goal({{"auto", 2, square},
                  {"solve/elastic_2d", "UMFPACK defaults", 2.5, 6},
                  1 / 0.25,
                  solve_by_default,
                  3},
                 failed);
  ElasticChoices wide{.level = 41, .method = "rbf_fd[phs=5,degree=6]", .stencil = "nearest[k=45]"};
  add_solve_goal({{"frontal", 2, wide},
                  {"solve/wide_stencils_2d", "UMFPACK defaults", 2.5, 4},
                  0,
                  solve_by_default,
                  5},
                 failed);
  const auto by_mumps = [](const LinearSystem& system) { return solve(system, "mumps"); };
  add_solve_goal({{"auto", 3, {.level = 31}},
                  {"solve/elastic_3d", "MUMPS with METIS", 5, 10},
                  1 / 0.15,
                  by_mumps,
                  1},
                 failed);
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
  const ElasticChoices one_face{.level = 44, .loaded = Loaded::first_upper_face};
  const std::vector<SolveCase> cases{{"umfpack", 2, square},       {"bicgstab", 2, square},
                                     {"umfpack", 3, second_order}, {"bicgstab", 3, second_order},
                                     {"bicgstab", 3, large},       {"auto", 3, one_face}};
  for (const SolveCase& choice : cases) {
    const std::string name =
        fmt::format("solve/{}/level:{}/{}d", choice.solver, choice.choices.level, choice.dim);
    benchmark::RegisterBenchmark(name.c_str(), [choice, &failed](benchmark::State& state) {
      run_guarded(state, failed, [&] { time_solve(state, choice); });
    })->Unit(benchmark::kMillisecond);
  }
  add_goals(failed);
  return run_registered(argc, argv, failed);
}

}  // namespace
}  // namespace strongpoint

int main(int argc, char** argv) { return strongpoint::run(argc, argv); }
