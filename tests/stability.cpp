#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "problems/core/growth.hpp"
#include "problems/core/integrator.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

using Complex = std::complex<double>;
using Kind = Damping::Kind;

/// Eigenvalues of any size up to e to the `powers`, at angles up to `spread` from the negative
/// axis.
Eigen::VectorXcd some_eigenvalues(int count, double spread, double powers = 8) {
  std::mt19937_64 generator(5);
  Eigen::VectorXcd values(count);
  for (Complex& value : values) {
    const double size = std::exp(powers * uniform01(generator));
    value = -std::polar(size, spread * (2 * uniform01(generator) - 1));
  }
  return values;
}

/// max Re s by the companion matrix of s^2 + a s - lambda, a being written out again.
double growth_by_companion(const Eigen::VectorXcd& eigenvalues, Kind kind, double strength,
                           double q) {
  double largest = -1e300;
  for (const Complex& lambda : eigenvalues) {
    const Complex a =
        kind == Kind::hyper ? strength * q * q * q * lambda * lambda : -strength * q * lambda;
    Eigen::Matrix2cd companion;
    companion << 0, 1, lambda, -a;
    largest = std::max(largest, companion.eigenvalues().real().maxCoeff());
  }
  return largest;
}

TEST(Growth, ItIsTheLargestRealPartOfTheDampedVibrations) {
  const Eigen::VectorXcd eigenvalues = some_eigenvalues(200, 0.5);
  const double q = 0.02;
  for (const double strength : {0.0, 0.003, 0.2, 5.0}) {
    for (const Kind kind : {Kind::stiffness, Kind::hyper}) {
      const double expected = growth_by_companion(eigenvalues, kind, strength, q);
      // Eigenvalues of companion matrices lose digits where roots are far apart.
      EXPECT_NEAR(fastest_growth(eigenvalues, {kind, strength}, q).rate, expected, 1e-9);
    }
  }
}

TEST(Growth, WithoutDampingItIsThatOfTheSquareRoots) {
  const Eigen::VectorXcd eigenvalues = some_eigenvalues(50, 3);
  const Growth growth = fastest_growth(eigenvalues, {}, 1);
  EXPECT_NEAR(growth.rate, eigenvalues.cwiseSqrt().real().maxCoeff(), 1e-12);
  EXPECT_NEAR(std::sqrt(growth.lambda).real(), growth.rate, 1e-12);
}

TEST(Growth, TheSmallestStrengthIsWhereGrowthEnds) {
  const double q = 0.02;
  for (const Kind kind : {Kind::stiffness, Kind::hyper}) {
    for (const double spread : {0.01, 0.2, 0.7}) {
      const Eigen::VectorXcd eigenvalues = some_eigenvalues(100, spread);
      const std::optional<double> found = smallest_strength(eigenvalues, kind, q);
      ASSERT_TRUE(found);
      const auto growth = [&](double factor) {
        return growth_by_companion(eigenvalues, kind, factor * *found, q);
      };
      EXPECT_GT(growth(1 - 1e-4), 0);
      EXPECT_LT(growth(1 + 1e-4), 0);
      for (double factor = 1.5; factor < 1e3; factor *= 1.5) EXPECT_LT(growth(factor), 0);
    }
  }
}

TEST(Growth, HyperviscosityDoesNotStopWhatLiesMoreThan45DegreesOffTheAxis) {
  const Complex inside = -std::polar(100.0, 0.78), outside = -std::polar(100.0, 0.79);
  Eigen::VectorXcd both(2);
  both << inside, outside;
  EXPECT_TRUE(smallest_strength(both.head(1), Kind::hyper, 1));
  EXPECT_FALSE(smallest_strength(both, Kind::hyper, 1));
  for (double g = 1e-8; g < 1e8; g *= 2) {
    EXPECT_GT(growth_by_companion(both, Kind::hyper, g, 1), 0);
  }
}

TEST(Growth, StiffnessDampingStopsAllButExponentials) {
  EXPECT_TRUE(smallest_strength(Eigen::VectorXcd::Constant(1, {-1, 50}), Kind::stiffness, 1));
  EXPECT_FALSE(smallest_strength(Eigen::VectorXcd::Constant(1, {1, 50}), Kind::stiffness, 1));
}

TEST(Growth, RealSpectraNeedNoDamping) {
  Eigen::VectorXcd eigenvalues(3);
  eigenvalues << -4000, -1, Complex(-2, 1e-12);
  for (const Kind kind : {Kind::stiffness, Kind::hyper}) {
    EXPECT_EQ(*smallest_strength(eigenvalues, kind, 0.1), 0);
  }
}

TEST(Growth, WithNextToNoToleranceTheSearchFindsTheClosedForm) {
  const double q = 0.3;
  for (const Kind kind : {Kind::stiffness, Kind::hyper}) {
    const Eigen::VectorXcd eigenvalues = some_eigenvalues(100, 0.01, 2);
    const double expected = *smallest_strength(eigenvalues, kind, q);
    // The precision promised, twice.
    EXPECT_NEAR(*strength_within(eigenvalues, kind, q, 1e-9, 1.5), expected, 2e-3 * expected);
  }
}

TEST(Growth, ToleratedGrowthNeedsLessDamping) {
  const double q = 0.2;
  const Eigen::VectorXcd eigenvalues = some_eigenvalues(100, 0.05, 3);
  const double strict = *strength_within(eigenvalues, Kind::hyper, q, 0, 1.5);
  const double tolerance = 0.1 * fastest_growth(eigenvalues, {}, q).rate;
  const double g = *strength_within(eigenvalues, Kind::hyper, q, tolerance, 1.5);
  EXPECT_LT(g, strict);
  EXPECT_GT(growth_by_companion(eigenvalues, Kind::hyper, 0.99 * g, q), tolerance);
  for (const double factor : {1.001, 1.1, 1.3, 1.5}) {
    EXPECT_LE(growth_by_companion(eigenvalues, Kind::hyper, factor * g, q), tolerance);
  }
}

TEST(Growth, DampingThatHelpsOnlyWhenItIsWeakIsFound) {
  // The first wants some damping, the second, 60 degrees off the axis and slow, grows with more.
  Eigen::VectorXcd eigenvalues(2);
  eigenvalues << -std::polar(100.0, 0.02), -std::polar(1e-4, 1.05);
  const double tolerance = 0.01;
  ASSERT_GT(fastest_growth(eigenvalues, {}, 0.2).rate, tolerance);
  EXPECT_FALSE(smallest_strength(eigenvalues, Kind::hyper, 0.2));
  const std::optional<double> g = strength_within(eigenvalues, Kind::hyper, 0.2, tolerance, 1.5);
  ASSERT_TRUE(g);
  EXPECT_LE(growth_by_companion(eigenvalues, Kind::hyper, 1.001 * *g, 0.2), tolerance);
}

TEST(Growth, NothingIsDampedThatDoesNotGrow) {
  const Eigen::VectorXcd eigenvalues = some_eigenvalues(100, 0.05, 3);
  const double growth = fastest_growth(eigenvalues, {}, 1).rate;
  EXPECT_EQ(*strength_within(eigenvalues, Kind::hyper, 1, 1.01 * growth, 1.5), 0);
}

TEST(Growth, AStepGrowsAsTheIntegratorItself) {
  const double q = 0.02;
  // The spectral radius of a step of the integrator is exact to the root of round-off where two
  // vibrations meet.
  constexpr double tolerance = 1e-7;
  for (const Damping& damping :
       {Damping{}, Damping{Kind::stiffness, 0.1}, Damping{Kind::hyper, 0.05}}) {
    for (const Complex& lambda : some_eigenvalues(20, 0.4)) {
      for (const double dt : {0.001, 0.01, 0.03}) {
        const double expected = amplification("central", lambda, damping, q, dt);
        const Eigen::VectorXcd one = Eigen::VectorXcd::Constant(1, lambda);
        EXPECT_NEAR(growth_per_step(one, damping, q, dt), expected, tolerance * expected);
      }
    }
  }
}

TEST(Growth, TheStableStepOfARealSpectrumIsThatOfItsRadius) {
  const double q = 0.05;
  Eigen::VectorXcd eigenvalues = -Eigen::VectorXcd::LinSpaced(64, 4 / (q * q) / 64, 4 / (q * q));
  for (const double g : {0.0, 0.02, 0.1, 0.4}) {
    const double step = stable_step(eigenvalues, {Kind::hyper, g}, q);
    EXPECT_NEAR(step, stable_step("central", 4 / (q * q), {Kind::hyper, g}, q), 1e-4 * step);
    // With lambda = -4 / q^2 and x = dt / q the last root passes -1 where x^2 + 8 g x = 1.
    EXPECT_NEAR(step / q, std::sqrt(16 * g * g + 1) - 4 * g, 1e-6);
  }
}

TEST(Growth, StepsUpToTheStableOneDoNotGrow) {
  const double q = 0.02;
  const Eigen::VectorXcd eigenvalues = some_eigenvalues(100, 0.1, 2);
  const Damping damping{Kind::hyper, 1.5 * *smallest_strength(eigenvalues, Kind::hyper, q)};
  const double step = stable_step(eigenvalues, damping, q);
  ASSERT_GT(step, 0);
  for (const double share : {0.05, 0.3, 0.7, 0.999}) {
    EXPECT_LE(growth_per_step(eigenvalues, damping, q, share * step), 1 + 1e-9);
  }
  EXPECT_GT(growth_per_step(eigenvalues, damping, q, 1.01 * step), 1);
}

TEST(Growth, TooWeakADampingHasNoStableStep) {
  const double q = 0.02;
  const Eigen::VectorXcd eigenvalues = some_eigenvalues(100, 0.1, 2);
  const double least = *smallest_strength(eigenvalues, Kind::hyper, q);
  EXPECT_EQ(stable_step(eigenvalues, {Kind::hyper, 0.5 * least}, q), 0);
}

TEST(StableStep, OfUndampedIntegratorsIsTheTextbooks) {
  constexpr double radius = 49;  // omega = 7
  // A tolerance of 1e-6 in the growth decides the limit; rk4 passes 1 with a finite slope.
  constexpr double precision = 3e-6;
  EXPECT_NEAR(stable_step("central", radius, {}, 1), 2.0 / 7, precision);
  EXPECT_NEAR(stable_step("rk4", radius, {}, 1), std::sqrt(8.0) / 7, precision);
  EXPECT_NEAR(stable_step("newmark[beta=0]", radius, {}, 1), 2.0 / 7, precision);
  // y^2 = 4 / (1 - 4 beta) with gamma = 1/2.
  EXPECT_NEAR(stable_step("newmark[beta=0.1]", radius, {}, 1), 2 / std::sqrt(0.6) / 7, precision);
  for (const char* spec : {"newmark", "generalised_alpha", "generalised_alpha[rho_inf=0]",
                           "generalised_alpha[rho_inf=1]"}) {
    EXPECT_TRUE(std::isinf(stable_step(spec, radius, {}, 1))) << spec;
    EXPECT_TRUE(std::isinf(stable_step(spec, radius, {Kind::stiffness, 0.1}, 1))) << spec;
  }
  EXPECT_TRUE(std::isinf(stable_step("central", 0, {}, 1)));
}

TEST(StableStep, OfDampedCentralDifferencesIsItsClosedForm) {
  constexpr double q = 0.05;
  constexpr double radius = 4 / (q * q);
  for (const double strength : {0.01, 0.1, 0.5, 5.0, 100.0}) {
    // x^2 + 8 g x = 1 and x^2 + 2 eta x = 1.
    const double with_hyper = 1 / (std::hypot(1, 4 * strength) + 4 * strength);
    const double with_stiffness = 1 / (std::hypot(1, strength) + strength);
    EXPECT_NEAR(stable_step("central", radius, {Kind::hyper, strength}, q) / q, with_hyper,
                1e-5 * with_hyper);
    EXPECT_NEAR(stable_step("central", radius, {Kind::stiffness, strength}, q) / q, with_stiffness,
                1e-5 * with_stiffness);
  }
}

}  // namespace
}  // namespace strongpoint
