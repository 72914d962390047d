#include "studies/support/stability_case.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/growth.hpp"
#include "problems/core/integrator.hpp"
#include "problems/core/random.hpp"
#include "problems/core/spectrum.hpp"
#include "studies/support/seeds.hpp"
#include "studies/support/transient_case.hpp"
#include "studies/support/waves.hpp"

namespace strongpoint {
namespace {

constexpr int most_unknowns = 2500;  // half a minute of dense algebra
constexpr double margin = 1.5;       // of the strength used over the smallest one
constexpr double step_share = 0.5;   // of the stable step
constexpr double largest_g = 0.5;    // what more does to resolved waves is worse than another rule

enum class Worst { largest, smallest };

/// A quantity's name, and which end of its range is bad.
struct Judged {
  std::string name;
  Worst worst;
};

std::vector<Judged> judged_quantities(const std::string& error) {
  return {{"growth_rate", Worst::largest},
          {"growing_frequency", Worst::smallest},
          {"smallest_g", Worst::largest},
          {"smallest_eta", Worst::largest},
          {"node_time", Worst::smallest},
          {"stable_step", Worst::smallest},
          {"steps_survived", Worst::smallest},
          {"damped_g", Worst::largest},
          {"stable_step_damped", Worst::smallest},
          {"steps_survived_damped", Worst::smallest},
          {error, Worst::largest},
          {"verdict", Worst::largest}};
}

Quantity quantity(std::string name, std::optional<double> value, std::string reason = {}) {
  return {std::move(name), value, std::move(reason), {}};
}

/// How far steps from noise came.
struct Run {
  std::int64_t steps, survived;
  bool is_bounded() const { return survived == steps; }
  Quantity as(const std::string& name) const {
    const std::string reason =
        is_bounded() ? "" : fmt::format("diverged at step {} of {}", survived + 1, steps);
    return quantity(name, static_cast<double>(survived), reason);
  }
};

/// Steps from noise until it has grown a millionfold.
Run step_noise(const Motion& motion, const Damping& damping, double node_time, double stable,
               const StabilityOptions& options, std::uint64_t seed) {
  constexpr double limit = 1e6;
  const auto steps = static_cast<std::int64_t>(std::ceil(options.t_end / (step_share * stable)));
  const DampedMotion damped(motion, damping, node_time);
  const LoadHistory none = [](double) { return 0.0; };
  const double dt = options.t_end / static_cast<double>(steps);
  const auto integrator = make_integrator("central", {damped, none, dt});
  MotionState state;
  state.displacement = random_vector(motion.size(), seed).normalized();
  state.velocity = Eigen::VectorXd::Zero(motion.size());
  integrator->start(state);
  while (state.step < steps) {
    integrator->advance(state);
    if (!(state.displacement.norm() <= limit)) return {steps, state.step - 1};
  }
  return {steps, steps};
}

/// What the damped case errs by at the end of its problem.
Quantity damped_error(const CaseKey& key, const RunOptions& options, const Damping& damping,
                      double dt) {
  TimeOptions time;
  time.time = fmt::format("central[dt={}]", dt);
  time.damping = damping.strength > 0 ? fmt::format("hyper[g={}]", damping.strength) : "none";
  RunOptions quiet = options;
  quiet.vtk.reset();
  Quantity error = run_transient_case(key, quiet, time).quantities.front();
  error.extra.clear();
  return error;
}

/// The smallest strength of a kind of damping, and why there is none: the growth that is left with
/// the strongest one that would be taken.
Quantity smallest(const std::string& name, const Eigen::VectorXcd& eigenvalues, Damping::Kind kind,
                  double node_time, double tolerance) {
  const std::optional<double> strength =
      strength_within(eigenvalues, kind, node_time, tolerance, margin);
  if (strength) return quantity(name, strength);
  const Growth left = fastest_growth(eigenvalues, {kind, largest_g}, node_time);
  return quantity(name, {},
                  fmt::format("no strength stops the growth of {:.3g}/time at the frequency "
                              "{:.3g}/q ({:.3g}/time with {})",
                              std::sqrt(left.lambda).real(),
                              std::sqrt(std::abs(left.lambda)) * node_time, left.rate, largest_g));
}

/// A scene with its spectrum.
template <int Dim>
struct Spectrum {
  Waves<Dim> waves;
  Eigen::VectorXcd eigenvalues;
  double node_time;

  Spectrum(const TransientProblem<Dim>& problem, const CaseKey& key, const RunOptions& options,
           StageTimes& times)
      : waves(make_waves<Dim>(problem, key, options, times)) {
    if (waves.motion->size() > most_unknowns) {
      throw SkipCase(
          fmt::format("a dense spectrum of {} unknowns is too dear, {} are taken; lower "
                      "--levels",
                      waves.motion->size(), most_unknowns));
    }
    eigenvalues = dense_eigenvalues(*waves.motion);
    if (!eigenvalues.allFinite() || eigenvalues.cwiseAbs().maxCoeff() == 0) {
      throw CaseError("the operator of motion is zero or not finite; take other stencils");
    }
    node_time = strongpoint::node_time<Dim>(problem, waves, eigenvalues.cwiseAbs().maxCoeff());
  }
};

/// The damped half of the quantities.
template <int Dim>
std::vector<Quantity> damped_quantities(const Spectrum<Dim>& spectrum, const Quantity& g,
                                        const CaseKey& key, const RunOptions& options,
                                        const StabilityOptions& stability,
                                        const std::string& error) {
  const double q = spectrum.node_time;
  const auto refused = [&](const std::string& reason) {
    return std::vector<Quantity>{quantity("damped_g", {}, reason),
                                 quantity("stable_step_damped", {}, reason),
                                 quantity("steps_survived_damped", {}, reason),
                                 quantity(error, {}, reason), quantity("verdict", 2, reason)};
  };
  if (!g.value) return refused(g.reason);
  if (*g.value > largest_g) {
    return refused(fmt::format("g = {:.3g}, above {}, would be needed", *g.value, largest_g));
  }
  const Damping damping{Damping::Kind::hyper, margin * *g.value};
  const double step = stable_step(spectrum.eigenvalues, damping, q, stability.tolerance);
  constexpr double shortest = 0.01;  // of q, where a run becomes too long to be of use
  if (step < shortest * q) {
    return refused(
        fmt::format("with g = {:.3g} steps must be below {} q", damping.strength, shortest));
  }
  const Run run = step_noise(*spectrum.waves.motion, damping, q, step, stability, options.seed);
  std::vector<Quantity> all{
      quantity("damped_g", damping.strength), quantity("stable_step_damped", step / q),
      run.as("steps_survived_damped"), damped_error(key, options, damping, step_share * step)};
  const bool is_safe = run.is_bounded() && all.back().value;
  all.push_back(quantity("verdict", !is_safe ? 2 : damping.strength > 0 ? 1 : 0));
  return all;
}

template <int Dim>
CaseResult judge(const TransientProblem<Dim>& problem, const CaseKey& key,
                 const RunOptions& options, const StabilityOptions& stability) {
  CaseResult result;
  const Spectrum<Dim> spectrum(problem, key, options, result.times);
  const double q = spectrum.node_time;
  const Growth growth = fastest_growth(spectrum.eigenvalues, {}, q);
  const auto smallest_of = [&](const char* name, Damping::Kind kind) {
    return smallest(name, spectrum.eigenvalues, kind, q, stability.tolerance);
  };
  const Quantity g = smallest_of("smallest_g", Damping::Kind::hyper);
  const double step = stable_step(spectrum.eigenvalues, {}, q);
  const Run run = step_noise(*spectrum.waves.motion, {}, q, step, stability, options.seed);
  result.quantities = {quantity("growth_rate", growth.rate),
                       quantity("growing_frequency", std::sqrt(std::abs(growth.lambda)) * q),
                       g,
                       smallest_of("smallest_eta", Damping::Kind::stiffness),
                       quantity("node_time", q),
                       quantity("stable_step", step / q),
                       run.as("steps_survived")};
  for (Quantity& damped :
       damped_quantities<Dim>(spectrum, g, key, options, stability, problem.quantities().front())) {
    result.quantities.push_back(std::move(damped));
  }
  result.nodes = spectrum.waves.scene->cloud.size();
  result.unknowns = spectrum.waves.motion->size();
  result.spacing = spectrum.waves.scene->cloud.spacing();
  return result;
}

/// The worst of one quantity over clouds.
Quantity worst_of(const std::vector<CaseResult>& results, std::size_t index, Worst worst,
                  std::size_t clouds, const StabilityOptions& options) {
  Quantity joined = results.front().quantities[index];
  std::vector<double> values;
  std::size_t reasons = 0;
  for (const CaseResult& result : results) {
    const Quantity& one = result.quantities[index];
    if (one.value) values.push_back(*one.value);
    if (!one.reason.empty() && reasons++ == 0) joined.reason = one.reason;
  }
  if (reasons > 0 && clouds > 1) {
    joined.reason = fmt::format("{} of {} clouds: {}", reasons, clouds, joined.reason);
  }
  joined.value.reset();
  joined.extra = {fmt::format("{}", clouds), "", "", fmt::format("{}", options.t_end),
                  fmt::format("{}", options.tolerance)};
  if (values.empty()) return joined;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  joined.extra[1] = fmt::format("{}", *low);
  joined.extra[2] = fmt::format("{}", *high);
  if (values.size() == results.size()) joined.value = worst == Worst::largest ? *high : *low;
  return joined;
}

}  // namespace

std::vector<std::string> stability_quantities(const CaseKey& key, const StabilityOptions& options) {
  with_seeds(key.cloud, 1, options.seeds);  // refuses seeds that are too large
  return with_problem<TransientProblem>(key.problem, "transient", [](const auto& problem) {
    std::vector<std::string> names;
    for (const Judged& judged : judged_quantities(problem.quantities().front())) {
      names.push_back(judged.name);
    }
    return names;
  });
}

CaseResult run_stability_case(const CaseKey& key, const RunOptions& options,
                              const StabilityOptions& stability) {
  return with_problem<TransientProblem>(
      key.problem, "transient", [&]<int Dim>(const TransientProblem<Dim>& problem) {
        std::vector<CaseResult> results;
        std::string failures;
        const std::vector<std::string> clouds =
            with_seeds(key.cloud, options.seed, stability.seeds);
        for (const std::string& cloud : clouds) {
          CaseKey one = key;
          one.cloud = cloud;
          try {
            results.push_back(judge<Dim>(problem, one, options, stability));
          } catch (const CaseError& error) {
            failures += fmt::format("{}{}: {}", failures.empty() ? "" : "; ", cloud, error.what());
          }
        }
        if (results.empty()) throw CaseError(failures);
        CaseResult joined = results.front();
        const std::vector<Judged> judged = judged_quantities(problem.quantities().front());
        for (std::size_t i = 0; i < judged.size(); ++i) {
          Quantity& quantity = joined.quantities[i];
          quantity = worst_of(results, i, judged[i].worst, clouds.size(), stability);
          if (failures.empty()) continue;
          // What cannot be computed on one cloud is not to be trusted on others.
          quantity.value = judged[i].name == "verdict" ? std::optional(2.0) : std::nullopt;
          quantity.reason = failures;
        }
        return joined;
      });
}

}  // namespace strongpoint
