#include "problems/core/integrator.hpp"

namespace strongpoint {
namespace {

class Central final : public Integrator {
 public:
  explicit Central(const Integration& integration)
      : in_(integration), acceleration_(integration.motion.size()) {}

  void start(MotionState& state) override {
    in_.motion.accelerate(state.displacement, state.velocity, in_.load(0), acceleration_);
    state.velocity -= in_.dt / 2 * acceleration_;
  }
  void advance(MotionState& state) override {
    const double time = static_cast<double>(state.step) * in_.dt;
    in_.motion.accelerate(state.displacement, state.velocity, in_.load(time), acceleration_);
    state.velocity += in_.dt * acceleration_;
    state.displacement += in_.dt * state.velocity;
    ++state.step;
  }

 private:
  Integration in_;
  Eigen::VectorXd acceleration_;
};

}  // namespace

/// Central differences, u(n+1) - 2 u(n) + u(n-1) = dt^2 u''(n), kept as u(n) and the velocity half
/// a step before; damping takes that velocity. Undamped it is stable up to dt = 2 / omega. Source:
/// thesis (4.8), (4.9).
IntegratorEntry integrator_central() {
  return {{"central", "central differences, explicit, second order", {}},
          [](const Options&, const Integration& integration) -> std::unique_ptr<Integrator> {
            return std::make_unique<Central>(integration);
          },
          true};
}

}  // namespace strongpoint
