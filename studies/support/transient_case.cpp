#include "studies/support/transient_case.hpp"

#include <cmath>

#include <fmt/format.h>

#include "problems/core/integrator.hpp"
#include "problems/core/spectrum.hpp"
#include "studies/support/waves.hpp"

namespace strongpoint {
namespace {

/// What bounds the displacements of a system that does not grow by itself.
class LoadBound {
 public:
  LoadBound(const MotionState& first, double load_norm)
      : speed_(first.velocity.norm()), distance_(first.displacement.norm()), load_(load_norm) {}
  void advance(double load, double dt) {
    speed_ += dt * std::abs(load) * load_;
    distance_ += dt * speed_;
  }
  bool holds(const Eigen::VectorXd& displacement) const {
    constexpr double factor = 1e3;
    const double size = displacement.norm();
    return std::isfinite(size) && size <= factor * distance_;
  }

 private:
  double speed_, distance_, load_;
};

/// -u.K u / 2 + v.v / 2.
double energy(const Motion& motion, const MotionState& state) {
  Eigen::VectorXd product(motion.size());
  motion.apply(state.displacement, product);
  return (state.velocity.squaredNorm() - state.displacement.dot(product)) / 2;
}

/// The steps of a run, all of one length, that end at its end.
struct Steps {
  std::string spec;
  double dt;
  std::int64_t count;
};

template <int Dim>
Steps steps_of(const TransientProblem<Dim>& problem, const TimeOptions& options, double q) {
  const TimeSpec time = parse_time(options.time.empty() ? "central" : options.time);
  const double end = options.t_end.value_or(problem.end_time());
  const double wanted = time.courant ? *time.courant * q : time.dt.value_or(problem.time_step());
  constexpr double slack = 1e-6;  // a quotient that is nearly a whole number is one
  const double count = std::max(1.0, std::ceil(end / wanted - slack));
  return {time.spec, end / count, static_cast<std::int64_t>(count)};
}

void check_step(const Steps& steps, const Motion& motion, const Damping& damping, double q) {
  const double radius = spectral_radius(motion);
  const double limit = stable_step(steps.spec, radius, damping, q);
  if (steps.dt <= limit) return;
  throw CaseError(fmt::format(
      "the step {:.4g} of {} exceeds {:.4g}, beyond which the fastest vibrations grow (spectral "
      "radius {:.4g}); take dt={:.3g} or courant={:.3g} at most",
      steps.dt, steps.spec, limit, radius, 0.95 * limit, 0.95 * limit / q));
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

template <int Dim>
CaseResult run(const TransientProblem<Dim>& problem, const CaseKey& key, const RunOptions& options,
               const TimeOptions& time_options) {
  const StageClock clock(options.threads);
  CaseResult result;
  reset_peak_memory();
  const Waves<Dim> waves = make_waves<Dim>(problem, key, options, result.times);
  const CondensedMotion& motion = *waves.motion;
  const Damping damping = make_damping(time_options.damping);
  MotionState state;
  Steps steps;
  double half_energy = 0;
  bool diverged = false;
  clock.time(result.times.solve, [&] {
    const double q = node_time<Dim>(problem, waves);
    steps = steps_of<Dim>(problem, time_options, q);
    check_step(steps, motion, damping, q);
    const DampedMotion damped(motion, damping, q);
    const LoadHistory load = [&](double t) { return problem.load(t); };
    const auto integrator = make_integrator(steps.spec, {damped, load, steps.dt});
    state = initial_state<Dim>(problem, waves);
    LoadBound bound(state, motion.load().norm());
    integrator->start(state);
    while (state.step < steps.count && !diverged) {
      bound.advance(load(static_cast<double>(state.step) * steps.dt), steps.dt);
      integrator->advance(state);
      diverged = !bound.holds(state.displacement);
      if (state.step == steps.count / 2) half_energy = energy(motion, state);
    }
  });
  result.times.peak_mb = peak_memory_mb();
  const double end = static_cast<double>(steps.count) * steps.dt;
  std::vector<double> values;
  if (!diverged) {
    const Solution<Dim> solution =
        solution_of<Dim>(*waves.scene, motion.all_unknowns(state.displacement, problem.load(end)));
    values = problem.measure(solution, end);
    values.push_back(energy(motion, state) / half_energy);
  }
  const std::string reason = diverged ? fmt::format("diverged at step {}", state.step) : "";
  const std::vector<std::string> names = transient_quantities(key);
  const std::vector<std::string> extra{steps.spec, fmt::format("{}", end), time_options.damping,
                                       fmt::format("{}", steps.dt), fmt::format("{}", steps.count)};
  for (std::size_t q = 0; q + 1 < names.size(); ++q) {
    const std::optional<double> value = diverged ? std::nullopt : std::optional<double>(values[q]);
    result.quantities.push_back({names[q], value, reason, extra});
  }
  result.quantities.push_back(
      {names.back(), static_cast<double>(diverged ? state.step - 1 : state.step), {}, extra});
  result.nodes = waves.scene->cloud.size();
  result.unknowns = waves.system.unknowns();
  result.spacing = waves.scene->cloud.spacing();
  return result;
}

}  // namespace

std::vector<OptionDoc> time_option_docs() {
  return {{"time", "", "problems in time: how steps are taken, as central[dt=1e-3]"},
          {"t-end", "", "problems in time: when they end"},
          {"damping", "none", "problems in time: none, stiffness[eta=0.02], hyper[g=0.02]"}};
}

TimeOptions time_options(const Options& extra) {
  TimeOptions options;
  if (extra.has("time")) options.time = parse_time(extra.text("time")).spec;
  if (extra.has("t-end")) options.t_end = extra.number("t-end", 1e-9, 1e9);
  options.damping = canonical_damping(extra.text("damping"));
  return options;
}

std::vector<std::string> time_columns() { return {"time", "t_end", "damping", "dt", "steps"}; }

std::vector<std::string> transient_quantities(const CaseKey& key) {
  return with_problem<TransientProblem>(key.problem, "transient", [](const auto& problem) {
    std::vector<std::string> names = problem.quantities();
    names.insert(names.end(), {"energy_ratio", "steps_survived"});
    return names;
  });
}

CaseResult run_transient_case(const CaseKey& key, const RunOptions& options,
                              const TimeOptions& time) {
  return with_problem<TransientProblem>(key.problem, "transient",
                                        [&]<int Dim>(const TransientProblem<Dim>& problem) {
                                          return run<Dim>(problem, key, options, time);
                                        });
}

}  // namespace strongpoint
