#include "studies/support/noise_run.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

constexpr std::int64_t least_steps = 8;  // two in each window

/// A sum of squares of numbers that are multiplied by exp(log_scale).
struct ScaledSum {
  double sum = 0, log_scale = 0, count = 0;

  void add(double square, double scale) {
    sum = sum * std::exp(2 * (log_scale - scale)) + square;
    log_scale = scale;
    ++count;
  }
  double log_root_mean() const { return std::log(sum / count) / 2 + log_scale; }
};

/// What is remembered of the steps so far.
struct Windows {
  double log_scale = 0;  ///< of the state
  ScaledSum early, late;
};

MotionState noise(int size) {
  MotionState state;
  state.displacement = random_vector(size, 1);
  state.velocity.setZero(size);
  return state;
}

/// Scales by a power of 2, which changes no digit, when the state has grown.
void keep_small(MotionState& state, double& square, double& log_scale) {
  constexpr int power = 300;
  const double factor = std::ldexp(1.0, -power);
  while (square > 1 / factor && std::isfinite(square)) {
    for (Eigen::VectorXd* part : {&state.displacement, &state.velocity, &state.acceleration}) {
      *part *= factor;
    }
    square *= factor * factor;
    log_scale += power * std::numbers::ln2;
  }
}

}  // namespace

Quantity noise_growth(const DampedMotion& motion, const Steps& steps,
                      const std::optional<Saving>& saving, CaseMonitor* monitor,
                      std::int64_t earlier) {
  Quantity growth{"growth_rate", {}, {}, {}};
  if (steps.count < least_steps) {
    growth.reason =
        fmt::format("the noise runs for less than {} steps; take --noise {:.3g} or more",
                    least_steps, steps.longest * least_steps);
    return growth;
  }
  const LoadHistory none = [](double) { return 0.0; };
  const auto integrator = make_integrator(steps.spec, {motion, none, steps.dt});
  MotionState state = noise(motion.size());
  integrator->start(state);
  Windows windows;
  bool finite = true;
  const auto after = [&](MotionState& now) {
    double square = now.displacement.squaredNorm();
    keep_small(now, square, windows.log_scale);
    finite = std::isfinite(square);
    const std::int64_t quarters = 4 * now.step;
    if (quarters >= steps.count && quarters <= 2 * steps.count) {
      windows.early.add(square, windows.log_scale);
    }
    if (quarters >= 3 * steps.count) windows.late.add(square, windows.log_scale);
    return finite;
  };
  march(state,
        {*integrator, steps.count, after, std::as_writable_bytes(std::span(&windows, 1)), saving,
         earlier, 0},
        monitor);
  const double rate =
      (windows.late.log_root_mean() - windows.early.log_root_mean()) / (steps.end / 2);
  if (!finite) {
    growth.reason = fmt::format("diverged at step {}", state.step);
  } else if (!std::isfinite(rate)) {
    growth.reason = "the noise dies out to nothing; take a shorter --noise";
  } else {
    growth.value = rate;
  }
  return growth;
}

}  // namespace strongpoint
