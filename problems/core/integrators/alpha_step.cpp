#include "problems/core/integrators/alpha_step.hpp"

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

class AlphaIntegrator final : public Integrator {
 public:
  AlphaIntegrator(const AlphaConstants& constants, const Integration& integration)
      : c_(constants),
        in_(integration),
        damping_time_(integration.motion.stiffness_time()),
        right_(integration.motion.size()),
        work_(integration.motion.size()) {
    const double dt = in_.dt;
    const double factor = (1 - c_.displacement) / (1 - c_.inertia) *
                          (c_.beta * dt * dt + damping_time_ * c_.gamma * dt);
    if (factor != 0) implicit_ = in_.motion.motion().shifted(factor);
  }

  void start(MotionState& state) override {
    state.acceleration.resize(state.displacement.size());
    in_.motion.accelerate(state.displacement, state.velocity, in_.load(0), state.acceleration);
  }

  /// The new displacement and velocity without the share of the new acceleration replace the old
  /// ones before the solve, which gives that acceleration.
  void advance(MotionState& state) override {
    const double dt = in_.dt;
    const double old = c_.displacement;
    const double time = (static_cast<double>(state.step) + 1 - old) * dt;
    work_ = old * state.displacement + (old * damping_time_) * state.velocity;
    state.displacement += dt * state.velocity + (dt * dt * (0.5 - c_.beta)) * state.acceleration;
    state.velocity += (dt * (1 - c_.gamma)) * state.acceleration;
    work_ += (1 - old) * state.displacement + ((1 - old) * damping_time_) * state.velocity;
    in_.motion.motion().apply(work_, right_);
    const double load = in_.load(time);
    if (load != 0) right_ += load * in_.motion.motion().load();
    if (c_.inertia != 0) right_ -= c_.inertia * state.acceleration;
    right_ /= 1 - c_.inertia;
    if (implicit_) {
      implicit_->solve(right_, state.acceleration);
    } else {
      state.acceleration = right_;
    }
    state.displacement += (dt * dt * c_.beta) * state.acceleration;
    state.velocity += (dt * c_.gamma) * state.acceleration;
    ++state.step;
  }

 private:
  AlphaConstants c_;
  Integration in_;
  double damping_time_;                      ///< s
  std::unique_ptr<ShiftedMotion> implicit_;  ///< null where the new acceleration is explicit
  Eigen::VectorXd right_, work_;
};

}  // namespace

std::unique_ptr<Integrator> make_alpha_integrator(std::string_view name,
                                                  const AlphaConstants& constants,
                                                  const Integration& integration) {
  if (integration.motion.damping().kind == Damping::Kind::hyper) {
    throw SkipCase(fmt::format(
        "{} cannot take the damping hyper, which brings K^2 into its matrix; take an explicit "
        "integrator (central, rk4) or the damping stiffness",
        name));
  }
  return std::make_unique<AlphaIntegrator>(constants, integration);
}

}  // namespace strongpoint
