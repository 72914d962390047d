#include "studies/support/transient_case.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "problems/core/integrator.hpp"
#include "problems/core/spectrum.hpp"
#include "studies/support/case_map.hpp"
#include "studies/support/frames.hpp"
#include "studies/support/march.hpp"
#include "studies/support/noise_run.hpp"
#include "studies/support/provenance.hpp"
#include "studies/support/vtk.hpp"
#include "studies/support/waves.hpp"

namespace strongpoint {
namespace {

/// What a run remembers from step to step beside its state.
struct Memory {
  double speed = 0;        ///< norm of velocities, at most, in a system that does not grow
  double half_energy = 0;  ///< energy at half of the run
};

/// -u.K u / 2 + v.v / 2.
double energy(const Motion& motion, const MotionState& state) {
  Eigen::VectorXd product(motion.size());
  motion.apply(state.displacement, product);
  return (state.velocity.squaredNorm() - state.displacement.dot(product)) / 2;
}

/// The values at all unknowns' nodes at time 0, field by field within a node.
template <int Dim>
Eigen::VectorXd at_unknowns(const Waves<Dim>& waves,
                            const std::function<Eigen::VectorXd(const Point<Dim>&)>& function) {
  const NodeUnknowns& unknowns = waves.scene->unknowns;
  const Points<Dim>& nodes = waves.scene->sites.nodes;
  const auto fields = static_cast<Eigen::Index>(waves.system.fields);
  Eigen::VectorXd values(fields * unknowns.count);
  for (int node = waves.scene->sites.node_count() - 1; node >= 0; --node) {
    values.segment(fields * unknowns.of(node), fields) = function(nodes.col(node));
  }
  return values;
}

template <int Dim>
MotionState initial_state(const TransientProblem<Dim>& problem, const Waves<Dim>& waves) {
  MotionState state;
  state.displacement = waves.motion->from_values(at_unknowns<Dim>(
      waves, [&](const Point<Dim>& x) { return problem.initial_displacement(x); }));
  state.velocity = waves.motion->from_values(
      at_unknowns<Dim>(waves, [&](const Point<Dim>& x) { return problem.initial_velocity(x); }));
  return state;
}

/// One case, from its equations to its rows.
template <int Dim>
class TransientRun {
 public:
  TransientRun(const TransientProblem<Dim>& problem, const CaseKey& key, const RunOptions& options,
               const TimeOptions& time)
      : problem_(problem), key_(key), options_(options), time_(time), clock_(options.threads) {}

  CaseResult run() {
    reset_peak_memory();
    waves_ = make_waves<Dim>(problem_, key_, options_, result_.times);
    clock_.time(result_.times.solve, [&] { choose_steps(); });
    const DampedMotion motion(*waves_.motion, make_damping(time_.damping), node_time_);
    run_loads(motion);
    result_.times.peak_mb = peak_memory_mb();
    judge_end();
    judge_noise(motion);
    for (const char* kind : {loads, noise}) {
      if (const auto saving = saving_of(kind)) saving->checkpoint.remove();
    }
    add("steps_survived", static_cast<double>(diverged_ ? state_.step - 1 : state_.step), "");
    result_.nodes = waves_.scene->cloud.size();
    result_.unknowns = waves_.system.unknowns();
    result_.spacing = waves_.scene->cloud.spacing();
    return std::move(result_);
  }

 private:
  static constexpr const char* loads = "loads";
  static constexpr const char* noise = "noise";

  const TransientProblem<Dim>& problem_;
  const CaseKey& key_;
  const RunOptions& options_;
  const TimeOptions& time_;
  StageClock clock_;
  CaseResult result_;
  Waves<Dim> waves_;
  double node_time_ = 0;  ///< of a wave from node to node
  double load_norm_ = 0;  ///< of the accelerations that data of size 1 cause
  Steps steps_, noise_steps_;
  MotionState state_;
  Memory memory_;
  bool diverged_ = false;
  std::vector<NodeArray> stencils_;  ///< of frames, once they are known

  void choose_steps();
  void run_loads(const DampedMotion& motion);
  bool look_at(const MotionState& state);
  void write_frame(const Frames& frames, const MotionState& state);
  void judge_end();
  void judge_noise(const DampedMotion& motion);

  /// The run in words, which tell it from any other run of the case.
  std::string words() const {
    return fmt::format("{}, dt {}, to {}, damping {}", steps_.spec, steps_.dt, steps_.end,
                       time_.damping);
  }
  std::optional<Saving> saving_of(const std::string& kind) const {
    if (time_.checkpoints.empty()) return std::nullopt;
    std::string run = fmt::format("{}, form {}; {}", title_of(key_), key_.form, words());
    if (kind == noise) run += fmt::format(", noise to {}", noise_steps_.end);
    if (kind == loads && options_.vtk && time_.frames > 1) {
      run += fmt::format(", {} frames in {}", time_.frames, options_.vtk->directory);
    }
    return Saving{Checkpoint(fmt::format("{}/{}_{}.checkpoint", time_.checkpoints,
                                         file_stem(key_, run), kind),
                             run, code_version()),
                  time_.checkpoint_seconds};
  }
  Solution<Dim> solution_at(const MotionState& state, double time) const {
    return solution_of<Dim>(*waves_.scene,
                            waves_.motion->all_unknowns(state.displacement, problem_.load(time)));
  }
  void add(const std::string& name, std::optional<double> value, const std::string& reason) {
    const std::string until = time_.noise ? fmt::format("{}", *time_.noise) : "";
    result_.quantities.push_back(
        {name,
         value,
         reason,
         {steps_.spec, fmt::format("{}", steps_.end), time_.damping, fmt::format("{}", steps_.dt),
          fmt::format("{}", steps_.count), until}});
  }
};

/// Chooses the steps, all the same in both runs as far as their ends allow, and refuses those that
/// are not stable.
template <int Dim>
void TransientRun<Dim>::choose_steps() {
  const TimeSpec time = parse_time(time_.integrator());
  const Damping damping = make_damping(time_.damping);
  const double radius = spectral_radius(*waves_.motion);
  node_time_ = strongpoint::node_time<Dim>(problem_, waves_, radius);
  const double longest =
      time.courant ? *time.courant * node_time_ : time.dt.value_or(problem_.time_step());
  steps_ = steps_until(time_.t_end.value_or(problem_.end_time()), longest, time.spec);
  if (time_.noise) noise_steps_ = steps_until(*time_.noise, longest, time.spec);
  const double limit = stable_step(time.spec, radius, damping, node_time_);
  const double dt = std::max(steps_.dt, noise_steps_.dt);
  if (dt <= limit) return;
  throw CaseError(fmt::format(
      "the step {:.4g} of {} exceeds {:.4g}, beyond which the fastest vibrations grow (spectral "
      "radius {:.4g}); take dt={:.3g} or courant={:.3g} at most",
      dt, time.spec, limit, radius, 0.95 * limit, 0.95 * limit / node_time_));
}

/// Looks at the state after a step: whether it may still be called a solution. Where K is symmetric
/// the root of twice the energy grows no faster than the accelerations of the load add up: those of
/// all steps before, and that at the end of this one, which may be the first that is not tiny.
template <int Dim>
bool TransientRun<Dim>::look_at(const MotionState& state) {
  constexpr double factor = 10;  // for K that is not symmetric
  const auto gained = [&](std::int64_t step) {
    return steps_.dt * std::abs(problem_.load(steps_.time(step))) * load_norm_;
  };
  memory_.speed += gained(state.step - 1);
  diverged_ = !(state.velocity.norm() <= factor * (memory_.speed + gained(state.step)));
  if (state.step == steps_.count / 2) memory_.half_energy = energy(*waves_.motion, state);
  return !diverged_;
}

template <int Dim>
void TransientRun<Dim>::write_frame(const Frames& frames, const MotionState& state) {
  const int frame = frames.at(state.step);
  if (frame == 0) return;
  if (stencils_.empty()) {
    stencils_ = stencil_arrays<Dim>(*waves_.scene, *Choices<Dim>(key_).method);
  }
  const double time = steps_.time(state.step);
  const Solution<Dim> solution = solution_at(state, time);
  std::vector<NodeArray> arrays = field_arrays<Dim>(problem_.space(), solution);
  for (NodeArray& derived : problem_.derived_fields(solution, time)) {
    arrays.push_back(std::move(derived));
  }
  arrays.insert(arrays.end(), stencils_.begin(), stencils_.end());
  const std::string title = fmt::format("{}; {}; t = {:.6g}", title_of(key_), words(), time);
  frames.write(frame, cloud_text<Dim>(waves_.scene->cloud, arrays, title, time));
}

template <int Dim>
void TransientRun<Dim>::run_loads(const DampedMotion& motion) {
  std::optional<Frames> frames;
  if (options_.vtk) {
    frames.emplace(vtu_path(*options_.vtk, key_, words()), time_.frames, steps_);
  }
  double writing = 0;
  clock_.time(result_.times.solve, [&] {
    const LoadHistory load = [&](double t) { return problem_.load(t); };
    const auto integrator = make_integrator(steps_.spec, {motion, load, steps_.dt});
    state_ = initial_state<Dim>(problem_, waves_);
    memory_ = {std::sqrt(2 * std::abs(energy(*waves_.motion, state_))), 0};
    load_norm_ = waves_.motion->load().norm();
    integrator->start(state_);
    const auto after = [&](const MotionState& state) {
      const bool goes_on = look_at(state);
      if (frames && goes_on) clock_.time(writing, [&] { write_frame(*frames, state); });
      return goes_on;
    };
    const March run{*integrator,
                    steps_.count,
                    after,
                    std::as_writable_bytes(std::span(&memory_, 1)),
                    saving_of(loads),
                    0,
                    noise_steps_.count};
    march(state_, run, options_.monitor);
    // Noise may be killed too, and then this run must not be repeated.
    if (time_.noise && !diverged_) save_state(state_, run);
  });
  result_.times.solve -= writing;
}

template <int Dim>
void TransientRun<Dim>::judge_end() {
  const std::vector<std::string> names = problem_.quantities();
  if (diverged_) {
    const std::string reason = fmt::format("diverged at step {}", state_.step);
    for (const std::string& name : names) add(name, {}, reason);
    add("energy_ratio", {}, reason);
    return;
  }
  const std::vector<double> values = problem_.measure(solution_at(state_, steps_.end), steps_.end);
  for (std::size_t q = 0; q < names.size(); ++q) add(names[q], values[q], "");
  const double ratio = energy(*waves_.motion, state_) / memory_.half_energy;
  if (std::isfinite(ratio)) {
    add("energy_ratio", ratio, "");
  } else {
    add("energy_ratio", {}, "nothing moves at half of the run");
  }
}

template <int Dim>
void TransientRun<Dim>::judge_noise(const DampedMotion& motion) {
  if (!time_.noise) {
    add("growth_rate", {}, "not measured; --noise T measures it");
    return;
  }
  const Quantity growth =
      noise_growth(motion, noise_steps_, saving_of(noise), options_.monitor, steps_.count);
  add(growth.name, growth.value, growth.reason);
}

}  // namespace

std::vector<std::string> transient_quantities(const CaseKey& key) {
  return with_problem<TransientProblem>(key.problem, "transient", [](const auto& problem) {
    std::vector<std::string> names = problem.quantities();
    names.insert(names.end(), {"energy_ratio", "growth_rate", "steps_survived"});
    return names;
  });
}

std::vector<std::string> unrated_quantities() {
  return {"stress_peak", "energy_ratio", "growth_rate", "steps_survived"};
}

CaseResult run_transient_case(const CaseKey& key, const RunOptions& options,
                              const TimeOptions& time) {
  return with_problem<TransientProblem>(
      key.problem, "transient", [&]<int Dim>(const TransientProblem<Dim>& problem) {
        return TransientRun<Dim>(problem, key, options, time).run();
      });
}

}  // namespace strongpoint
