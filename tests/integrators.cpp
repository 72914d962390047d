#include <array>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "problems/core/integrator.hpp"
#include "tests/linear_systems.hpp"
#include "tests/matrix_motion.hpp"

namespace strongpoint {
namespace {

using Complex = std::complex<double>;

const std::vector<std::string>& all_specs() {
  static const std::vector<std::string> specs{"central",           "rk4",
                                              "newmark",           "newmark[beta=0]",
                                              "generalised_alpha", "generalised_alpha[rho_inf=1]"};
  return specs;
}

bool takes(const std::string& spec, const Damping& damping) {
  return parse_time(spec).is_explicit || damping.kind != Damping::Kind::hyper;
}

/// What a motion does from its state at rest or another, over some steps.
MotionState run(const std::string& spec, const DampedMotion& motion, const LoadHistory& load,
                double dt, int steps, MotionState state) {
  const auto integrator = make_integrator(spec, {motion, load, dt});
  integrator->start(state);
  for (int i = 0; i < steps; ++i) integrator->advance(state);
  return state;
}

MotionState initial(double displacement, double velocity) {
  MotionState state;
  state.displacement = Eigen::VectorXd::Constant(1, displacement);
  state.velocity = Eigen::VectorXd::Constant(1, velocity);
  return state;
}

// One vibration: omega, q, strengths chosen so that every damping is felt but none is critical.
constexpr double omega = 3;
constexpr double node_time = 0.4;
constexpr Damping undamped{};
constexpr Damping stiffness{Damping::Kind::stiffness, 0.1};
constexpr Damping hyper{Damping::Kind::hyper, 0.05};

/// Coefficient of -u' for a vibration.
double rate(const Damping& damping, double frequency, double q) {
  const double square = frequency * frequency;
  switch (damping.kind) {
    case Damping::Kind::none:
      return 0;
    case Damping::Kind::stiffness:
      return damping.strength * q * square;
    case Damping::Kind::hyper:
      return damping.strength * q * q * q * square * square;
  }
  return 0;
}

/// u(t) of u'' = -omega^2 u - d u' + exp(-t), u(0) = 1, u'(0) = 2.
double exact(double t, const Damping& damping) {
  const double d = rate(damping, omega, node_time);
  const double forced = 1 / (1 - d + omega * omega);
  const double frequency = std::sqrt(omega * omega - d * d / 4);
  const double cosine = 1 - forced;
  const double sine = (2 + forced + d / 2 * cosine) / frequency;
  return forced * std::exp(-t) +
         std::exp(-d / 2 * t) * (cosine * std::cos(frequency * t) + sine * std::sin(frequency * t));
}

double error_at_two(const std::string& spec, const Damping& damping, int steps) {
  const MatrixMotion motion(Eigen::MatrixXd::Constant(1, 1, -omega * omega),
                            Eigen::VectorXd::Constant(1, 1));
  const DampedMotion damped(motion, damping, node_time);
  const MotionState end = run(
      spec, damped, [](double t) { return std::exp(-t); }, 2.0 / steps, steps, initial(1, 2));
  return std::abs(end.displacement[0] - exact(2, damping));
}

TEST(Integrators, ReachTheirOrderOnAForcedVibrationWithAndWithoutDamping) {
  struct Expected {
    std::string spec;
    Damping damping;
    double order;
  };
  // Central differences take the velocity half a step before, which costs an order when damped.
  const std::vector<Expected> cases{{"central", undamped, 2},
                                    {"central", stiffness, 1},
                                    {"central", hyper, 1},
                                    {"rk4", undamped, 4},
                                    {"rk4", stiffness, 4},
                                    {"rk4", hyper, 4},
                                    {"newmark", undamped, 2},
                                    {"newmark", stiffness, 2},
                                    {"newmark[beta=0]", undamped, 2},
                                    {"newmark[gamma=0.8,beta=0.5]", undamped, 1},
                                    {"generalised_alpha", undamped, 2},
                                    {"generalised_alpha", stiffness, 2},
                                    {"generalised_alpha[rho_inf=0]", stiffness, 2},
                                    {"generalised_alpha[rho_inf=1]", stiffness, 2}};
  for (const Expected& expected : cases) {
    const double order = std::log2(error_at_two(expected.spec, expected.damping, 400) /
                                   error_at_two(expected.spec, expected.damping, 800));
    EXPECT_NEAR(order, expected.order, 0.05) << expected.spec;
  }
}

TEST(Integrators, StartAndEndWithTheVelocityTheyPromise) {
  const MatrixMotion motion(Eigen::MatrixXd::Constant(1, 1, -omega * omega),
                            Eigen::VectorXd::Zero(1));
  const DampedMotion free(motion, undamped, node_time);
  const LoadHistory none = [](double) { return 0.0; };
  constexpr double dt = 1e-3;
  constexpr int steps = 1000;
  for (const std::string& spec : all_specs()) {
    const MotionState end = run(spec, free, none, dt, steps, initial(1, 0));
    const double time = spec == "central" ? 1 - dt / 2 : 1.0;
    EXPECT_EQ(end.step, steps);
    // dt^2 omega^3 / 12 and the like for the slowest order.
    EXPECT_NEAR(end.velocity[0], -omega * std::sin(omega * time), 2e-5) << spec;
  }
}

TEST(Amplification, EqualsTheGrowthOfALongRun) {
  const Complex lambda(-9, 1.5);
  Eigen::Matrix2d matrix;
  matrix << lambda.real(), -lambda.imag(), lambda.imag(), lambda.real();
  const MatrixMotion motion(matrix);
  const LoadHistory none = [](double) { return 0.0; };
  constexpr double dt = 0.1;
  constexpr int steps = 400;
  for (const std::string& spec : all_specs()) {
    for (const Damping& damping : {undamped, stiffness, hyper}) {
      if (!takes(spec, damping)) continue;
      const DampedMotion damped(motion, damping, node_time);
      MotionState state;
      state.displacement = state.velocity = Eigen::Vector2d(1, 0.3);
      const MotionState middle = run(spec, damped, none, dt, steps, state);
      const MotionState end = run(spec, damped, none, dt, 2 * steps, state);
      const double growth = std::log(end.displacement.norm() / middle.displacement.norm()) / steps;
      // What the run's weaker mode still adds after 400 steps is round-off.
      EXPECT_NEAR(std::log(amplification(spec, lambda, damping, node_time, dt)), growth, 1e-9)
          << spec;
    }
  }
}

/// The larger root of z^2 + d z - lambda = 0 and its partner.
std::array<Complex, 2> roots(Complex lambda, double d) {
  const Complex gap = std::sqrt(d * d / 4 + lambda);
  return {-d / 2 + gap, -d / 2 - gap};
}

TEST(Amplification, OfRungeKuttaIsItsPolynomialAtTheRootsOfTheDampedMotion) {
  for (const Damping& damping : {undamped, stiffness, hyper}) {
    for (const double frequency : {1.0, 5.0, 9.0}) {
      constexpr double dt = 0.2;
      double expected = 0;
      for (const Complex& root :
           roots(-frequency * frequency, rate(damping, frequency, node_time))) {
        const Complex z = root * dt;
        expected = std::max(
            expected, std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))));
      }
      EXPECT_NEAR(amplification("rk4", -frequency * frequency, damping, node_time, dt), expected,
                  1e-12 * std::max(1.0, expected));
    }
  }
}

TEST(Amplification, TendsToTheDecayOfTheDampedMotionAsStepsShorten) {
  constexpr double dt = 1e-4;
  for (const Damping& damping : {stiffness, hyper}) {
    const double decay = -rate(damping, omega, node_time) / 2;
    for (const std::string& spec : all_specs()) {
      // The latter carries an alternating acceleration that neither grows nor decays.
      if (!takes(spec, damping) || spec == "generalised_alpha[rho_inf=1]") continue;
      const double growth =
          std::log(amplification(spec, -omega * omega, damping, node_time, dt)) / dt;
      // Central differences with the velocity of half a step before decay as ln(1 - d dt) / (2 dt).
      EXPECT_NEAR(growth / decay, 1, spec == "central" ? 1e-4 : 1e-7) << spec;
    }
  }
}

TEST(Amplification, OfGeneralisedAlphaAtHighFrequencyIsRhoInf) {
  for (const double rho : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    const Amplification growth(fmt::format("generalised_alpha[rho_inf={}]", rho));
    // A triple eigenvalue at infinity splits with the cube root of 1 / (omega dt)^2.
    EXPECT_NEAR(growth(-1e12, undamped, 1, 1), rho, 2e-3) << rho;
    EXPECT_NEAR(growth(-1e-4, undamped, 1, 1), 1, 1e-6) << rho;
  }
}

TEST(Integrators, KeepTheEnergyWithNewmarkAtAnyStep) {
  Eigen::Matrix3d matrix;
  matrix << -5, 1, 0.5, 1, -4, 2, 0.5, 2, -1000;
  const MatrixMotion motion(matrix);
  const DampedMotion free(motion, undamped, 1);
  const auto energy = [&](const MotionState& state) {
    return (state.velocity.squaredNorm() - state.displacement.dot(matrix * state.displacement)) / 2;
  };
  const LoadHistory none = [](double) { return 0.0; };
  for (const char* spec : {"newmark", "generalised_alpha[rho_inf=1]"}) {
    MotionState state;
    state.displacement = Eigen::Vector3d(1, -0.4, 0.2);
    state.velocity = Eigen::Vector3d(0.3, 2, -1);
    const double first = energy(state);
    const MotionState end = run(spec, free, none, 0.7, 1000, state);
    if (std::string(spec) == "newmark") {
      EXPECT_NEAR(energy(end) / first, 1, 1e-11);  // round-off of 1000 steps
    } else {
      EXPECT_LT(energy(end) / first, 10);  // bounded: it keeps another quadratic form
    }
  }
}

TEST(Integrators, ContinueFromACopiedStateToTheSameBits) {
  std::mt19937_64 generator(7);
  const Eigen::MatrixXd matrix = -dominant_matrix(6, 0.5, generator);
  const MatrixMotion motion(matrix, random_vector(6, generator));
  const LoadHistory load = [](double t) { return std::sin(3 * t); };
  MotionState first;
  first.displacement = random_vector(6, generator);
  first.velocity = random_vector(6, generator);
  for (const std::string& spec : all_specs()) {
    for (const Damping& damping : {undamped, stiffness, hyper}) {
      if (!takes(spec, damping)) continue;
      const DampedMotion damped(motion, damping, node_time);
      const MotionState whole = run(spec, damped, load, 0.05, 60, first);
      MotionState state = run(spec, damped, load, 0.05, 23, first);
      const auto fresh = make_integrator(spec, {damped, load, 0.05});
      while (state.step < 60) fresh->advance(state);
      EXPECT_EQ(state.displacement, whole.displacement) << spec;
      EXPECT_EQ(state.velocity, whole.velocity) << spec;
      EXPECT_EQ(state.acceleration, whole.acceleration) << spec;
    }
  }
}

TEST(Integrators, RefuseWhatTheyCannotTakeAndSayWhatToDo) {
  const MatrixMotion motion(-Eigen::MatrixXd::Identity(2, 2));
  const DampedMotion damped(motion, hyper, 1);
  const LoadHistory none = [](double) { return 0.0; };
  for (const char* spec : {"newmark", "generalised_alpha"}) {
    const std::string message = message_of<SkipCase>([&] {
      make_integrator(spec, {damped, none, 0.1});
    });
    EXPECT_NE(message.find(spec), std::string::npos) << message;
    EXPECT_NE(message.find("hyper"), std::string::npos) << message;
    EXPECT_NE(message.find("rk4"), std::string::npos) << message;
  }
  EXPECT_THROW(parse_time("leapfrog"), UsageError);
  EXPECT_THROW(parse_time("newmark[beta=0.7]"), UsageError);
  EXPECT_THROW(parse_time("newmark[gamma=0.4]"), UsageError);
  EXPECT_THROW(parse_time("generalised_alpha[rho_inf=1.5]"), UsageError);
  EXPECT_THROW(parse_time("rk4[dt=1e-3,courant=0.5]"), UsageError);
  EXPECT_THROW(parse_time("central[dt=-1]"), UsageError);
}

}  // namespace
}  // namespace strongpoint
