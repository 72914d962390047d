#include "problems/core/integrator.hpp"

namespace strongpoint {
namespace {

class Rk4 final : public Integrator {
 public:
  explicit Rk4(const Integration& integration)
      : in_(integration),
        displacement_(integration.motion.size()),
        velocity_(integration.motion.size()),
        acceleration_(integration.motion.size()),
        distance_(integration.motion.size()),
        speed_(integration.motion.size()) {}

  void start(MotionState&) override {}
  void advance(MotionState& state) override {
    const double dt = in_.dt;
    const double time = static_cast<double>(state.step) * dt;
    const double half_load = in_.load(time + dt / 2);
    displacement_ = state.displacement;
    velocity_ = state.velocity;
    distance_.setZero();
    speed_.setZero();
    add_slopes(in_.load(time), dt / 6);
    to_stage(state, dt / 2);
    add_slopes(half_load, dt / 3);
    to_stage(state, dt / 2);
    add_slopes(half_load, dt / 3);
    to_stage(state, dt);
    add_slopes(in_.load(time + dt), dt / 6);
    state.displacement += distance_;
    state.velocity += speed_;
    ++state.step;
  }

 private:
  Integration in_;
  Eigen::VectorXd displacement_, velocity_, acceleration_;  ///< of a stage
  Eigen::VectorXd distance_, speed_;                        ///< what the step adds

  /// Adds the slopes of the stage times their share of the step.
  void add_slopes(double load, double share) {
    in_.motion.accelerate(displacement_, velocity_, load, acceleration_);
    distance_ += share * velocity_;
    speed_ += share * acceleration_;
  }
  /// Moves on to the stage that the slopes of this one reach after a time.
  void to_stage(const MotionState& state, double after) {
    displacement_ = state.displacement + after * velocity_;
    velocity_ = state.velocity + after * acceleration_;
  }
};

}  // namespace

/// The classical Runge-Kutta method for (u, u'); four evaluations of the acceleration a step.
/// Undamped it is stable up to dt = 2 sqrt(2) / omega. Source: Kutta 1901; Hairer, Norsett & Wanner
/// 1993, II.1.
IntegratorEntry integrator_rk4() {
  return {{"rk4", "classical Runge-Kutta, explicit, fourth order", {}},
          [](const Options&, const Integration& integration) -> std::unique_ptr<Integrator> {
            return std::make_unique<Rk4>(integration);
          },
          true};
}

}  // namespace strongpoint
