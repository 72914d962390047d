#include "problems/core/jet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace strongpoint {
namespace {

// Rounding acts on the Taylor coefficients, derivatives over alpha!, which are of order 1 here:
// that far, or relative to itself, a derivative may be off after a few hundred operations.
constexpr double round_off = 1e-13;

template <int Dim>
double tolerance(const MultiIndex<Dim>& alpha, double expected) {
  return round_off * std::max(factorial<Dim>(alpha), std::abs(expected));
}

/// Compares every derivative of a jet with a closed form given as a function of the multi-index.
template <int Dim, int Order, class Expected>
void expect_derivatives(const Jet<Dim, Order>& jet, const Expected& expected) {
  for (const MultiIndex<Dim>& alpha : Derivatives<Dim>::between_orders(0, Order)) {
    const double value = expected(alpha);
    EXPECT_NEAR(jet.derivative(alpha), value, tolerance<Dim>(alpha, value)) << name_of<Dim>(alpha);
  }
}

/// Derivative number k of sin(frequency * t) at t.
double sine_derivative(int k, double frequency, double t) {
  const std::array<double, 4> cycle{std::sin(frequency * t), std::cos(frequency * t),
                                    -std::sin(frequency * t), -std::cos(frequency * t)};
  return std::pow(frequency, k) * cycle.at(k % 4);
}

/// p (p - 1) ... (p - k + 1), the factor that k derivatives of t^p bring down.
double falling_factorial(double p, int k) {
  double result = 1;
  for (int i = 0; i < k; ++i) result *= p - i;
  return result;
}

TEST(JetTables, ListMonomialsInTheOrderOfDerivatives) {
  const auto check = []<int Dim>(Dimension<Dim>) {
    const Derivatives<Dim> all = Derivatives<Dim>::between_orders(0, 8);
    const JetTables<Dim, 8>& tables = jet_tables<Dim, 8>;
    ASSERT_EQ(all.size(), (JetTables<Dim, 8>::size));
    for (int i = 0; i < all.size(); ++i) {
      EXPECT_EQ(tables.exponents[i], all[i]);
      EXPECT_EQ(tables.position(all[i]), i);
    }
  };
  check(Dimension<1>{});
  check(Dimension<2>{});
  check(Dimension<3>{});
}

TEST(Jet, OfAConstantHasNoDerivatives) {
  expect_derivatives(Jet<2, 3>(7.5), [](const MultiIndex<2>& alpha) {
    return order_of<2>(alpha) == 0 ? 7.5 : 0.0;
  });
}

TEST(Jet, OfOrderZeroIsItsValue) {
  const auto jet = jets_at<2, 0>([](const auto& x) { return exp(x[0]) * sin(x[1]) / (x[0] + 2); },
                                 Point<2>(0.3, 0.7));
  EXPECT_DOUBLE_EQ(jet.value(), std::exp(0.3) * std::sin(0.7) / 2.3);
}

TEST(Jet, RefusesADerivativeItDoesNotCarry) {
  EXPECT_THROW((void)(Jet<2, 2>::variable(1, 0).derivative({2, 1})), std::logic_error);
}

TEST(Jet, DifferentiatesPolynomialsExactlyIn3D) {
  // Whole numbers below 2^53 throughout, so that not even the last bit may differ.
  const auto polynomial = [](const auto& x) {
    return 3.0 * x[0] * x[0] * x[1] * x[2] * x[2] * x[2] - 2.0 * x[1] * x[1] * x[2] + x[0] - 5.0;
  };
  const Point<3> at(2, -3, 4);
  const auto jet = jets_at<3, 8>(polynomial, at);
  const auto monomial = [&at](const MultiIndex<3>& powers, const MultiIndex<3>& alpha) {
    double value = 1;
    for (int c = 0; c < 3; ++c) {
      value *= falling_factorial(powers[c], alpha[c]) *
               (alpha[c] <= powers[c] ? std::pow(at[c], powers[c] - alpha[c]) : 0);
    }
    return value;
  };
  for (const MultiIndex<3>& alpha : Derivatives<3>::between_orders(0, 8)) {
    const double expected = 3 * monomial({2, 1, 3}, alpha) - 2 * monomial({0, 2, 1}, alpha) +
                            monomial({1, 0, 0}, alpha) - 5 * monomial({0, 0, 0}, alpha);
    EXPECT_EQ(jet.derivative(alpha), expected) << name_of<3>(alpha);
  }
}

TEST(Jet, DifferentiatesExponentialTimesSineIn2D) {
  const double x = 0.4;
  const double y = -0.9;
  const auto jet =
      jets_at<2, 8>([](const auto& p) { return exp(p[0]) * sin(2.0 * p[1]); }, Point<2>(x, y));
  expect_derivatives(jet, [&](const MultiIndex<2>& alpha) {
    return std::exp(x) * sine_derivative(alpha[1], 2, y);
  });
}

TEST(Jet, DifferentiatesSineCosineProductIn3D) {
  const Point<3> at(0.3, 0.8, -0.2);
  const auto jet = jets_at<3, 8>(
      [](const auto& p) { return sin(2.0 * p[0] + 1.0) * cos(3.0 * p[1]) * sin(p[2] + 1.0); }, at);
  expect_derivatives(jet, [&](const MultiIndex<3>& alpha) {
    const double quarter_turn = std::acos(-1.0) / 2;
    return sine_derivative(alpha[0], 2, at[0] + 0.5) *
           sine_derivative(alpha[1], 3, at[1] + quarter_turn / 3) *
           sine_derivative(alpha[2], 1, at[2] + 1);
  });
}

TEST(Jet, DifferentiatesRungesFunction) {
  // 1 / (1 + 25 x^2) is the imaginary part of -1/5 / (x + i/5), differentiated as a complex power.
  const double x = 0.35;
  const auto jet =
      jets_at<1, 8>([](const auto& p) { return 1.0 / (1.0 + 25.0 * p[0] * p[0]); }, Point<1>(x));
  const double radius = std::hypot(x, 0.2);
  const double angle = std::atan2(0.2, x);
  expect_derivatives(jet, [&](const MultiIndex<1>& alpha) {
    const int k = alpha[0];
    return falling_factorial(-1, k) * std::pow(radius, -1 - k) * std::sin((1 + k) * angle) / 5;
  });
}

TEST(Jet, DifferentiatesPowersAndRoots) {
  const double x = 1.7;
  const auto power_of = [x](double p) {
    return [x, p](const MultiIndex<1>& alpha) {
      return falling_factorial(p, alpha[0]) * std::pow(x, p - alpha[0]);
    };
  };
  const auto variable = Jet<1, 8>::variable(x, 0);
  expect_derivatives(sqrt(variable), power_of(0.5));
  expect_derivatives(pow(variable, -1.5), power_of(-1.5));
  expect_derivatives(pow(variable, 3), power_of(3));
  expect_derivatives(1.0 / variable, power_of(-1));
}

TEST(Jet, TakesWholePowersOfZeroAndNegativeNumbers) {
  const auto at_zero = pow(Jet<1, 4>::variable(0, 0), 3);
  expect_derivatives(at_zero, [](const MultiIndex<1>& alpha) { return alpha[0] == 3 ? 6.0 : 0.0; });
  expect_derivatives(pow(Jet<1, 4>::variable(-2, 0), -2), [](const MultiIndex<1>& alpha) {
    return falling_factorial(-2, alpha[0]) * std::pow(-2.0, -2 - alpha[0]);
  });
}

TEST(Jet, GivesNaNOrInfinityWhereARootIsNotSmooth) {
  EXPECT_FALSE(std::isfinite(sqrt(Jet<1, 2>::variable(0, 0)).derivative({1})));
  EXPECT_TRUE(std::isnan(sqrt(Jet<1, 2>::variable(-1, 0)).value()));
  EXPECT_FALSE(std::isfinite((1.0 / Jet<1, 2>::variable(0, 0)).value()));
}

TEST(Jet, DifferentiatesLogarithm) {
  const double x = 0.6;
  expect_derivatives(log(Jet<1, 8>::variable(x, 0)), [x](const MultiIndex<1>& alpha) {
    const int k = alpha[0];
    return k == 0 ? std::log(x) : falling_factorial(-1, k - 1) * std::pow(x, -k);
  });
}

TEST(Jet, DifferentiatesTheAngleInEveryQuadrant) {
  // The angle is the imaginary part of log(x + i y): a derivative is that of
  // (-1)^(k-1) (k-1)! i^b / (x + i y)^k, with k = a + b.
  for (const Point<2>& at : {Point<2>(1.2, 0.5), Point<2>(-0.4, 0.9), Point<2>(-1.1, -0.3),
                             Point<2>(0.2, -0.8), Point<2>(0.0, 1.5), Point<2>(-2.0, 0.0)}) {
    const auto jet = jets_at<2, 8>([](const auto& p) { return atan2(p[1], p[0]); }, at);
    const double radius = at.norm();
    const double angle = std::atan2(at[1], at[0]);
    expect_derivatives(jet, [&](const MultiIndex<2>& alpha) {
      const int k = alpha[0] + alpha[1];
      if (k == 0) return angle;
      const double quarter_turns = alpha[1] * std::acos(-1.0) / 2;
      const double modulus = falling_factorial(-1, k - 1) * std::pow(radius, -k);
      return modulus * std::sin(quarter_turns - k * angle);
    });
  }
}

TEST(Jet, DifferentiatesTangentAndItsInverse) {
  const double x = 0.45;
  const auto variable = Jet<1, 8>::variable(x, 0);
  const auto tangent = tan(variable);
  // tan' = 1 + tan^2 as an identity between jets, one order lower.
  const auto right = 1.0 + tangent * tangent;
  for (int k = 1; k <= 8; ++k) {
    const double expected = right.derivative({k - 1});
    EXPECT_NEAR(tangent.derivative({k}), expected, tolerance<1>({k}, expected)) << k;
  }
  expect_derivatives(atan(tangent), [x](const MultiIndex<1>& alpha) {
    return alpha[0] == 0 ? x : alpha[0] == 1 ? 1.0 : 0.0;
  });
}

TEST(Jet, FunctionsAndTheirInversesCancel) {
  const auto x = Jet<3, 6>::variable(0.7, 0);
  const auto y = Jet<3, 6>::variable(1.3, 1);
  const auto z = Jet<3, 6>::variable(-0.4, 2);
  const auto inner = 2.0 + x * y - sin(z) * y;
  const auto same = [&inner](const MultiIndex<3>& alpha) { return inner.derivative(alpha); };
  expect_derivatives(log(exp(inner)), same);
  expect_derivatives(exp(log(inner)), same);
  expect_derivatives(sqrt(inner) * sqrt(inner), same);
  expect_derivatives(inner * z / z, same);
  auto one = inner;
  const auto& itself = one;
  one /= itself;
  expect_derivatives(one * inner, same);
  expect_derivatives(pow(pow(inner, 2.5), 0.4), same);
  expect_derivatives(sin(inner) * sin(inner) + cos(inner) * cos(inner) - 1.0,
                     [](const MultiIndex<3>&) { return 0.0; });
}

TEST(Jet, MixesWithNumbersOnEitherSide) {
  const auto x = Jet<1, 3>::variable(4, 0);
  EXPECT_EQ((3 - x).value(), -1);
  EXPECT_EQ((3 - x).derivative({1}), -1);
  EXPECT_EQ((x - 3).derivative({1}), 1);
  EXPECT_EQ((2 * x / 4).value(), 2);
  EXPECT_EQ((8 / x).derivative({1}), -0.5);
  EXPECT_EQ((-x).derivative({1}), -1);
}

TEST(Jet, ComparesByValue) {
  using Linear = Jet<1, 1>;
  const auto x = Linear::variable(2, 0);
  EXPECT_TRUE(x < 3.0);
  EXPECT_TRUE(x > Linear(1.0));
  EXPECT_TRUE(x == Linear(2.0));
  EXPECT_FALSE(Linear(std::nan("")) < x);
}

/// A function that goes through every operation, for doubles and jets alike.
struct Tangle {
  template <class T>
  T operator()(const std::array<T, 3>& x) const {
    using std::atan2, std::cos, std::exp, std::log, std::pow, std::sin, std::sqrt, std::tan;
    const T r = sqrt(x[0] * x[0] + x[1] * x[1] + 1.0);
    return exp(-x[0]) * pow(r, 1.3) / (2.0 + cos(x[2])) + log(3.0 + x[1] * x[2]) - tan(x[0] / 4.0) +
           atan2(x[1], x[0]) * sin(x[2]);
  }
};

TEST(Jet, AgreesWithCentralDifferencesOfOneOrderLess) {
  // Differencing the (q-1)th derivatives of jets at neighbouring points tests each order by itself;
  // the step balances its square against round-off over it.
  constexpr double step = 1e-5;
  constexpr double difference_error = 2e-7;
  const Point<3> at(0.6, 0.9, -0.5);
  EXPECT_NEAR((jets_at<3, 5>(Tangle{}, at).value()), Tangle{}(std::array{0.6, 0.9, -0.5}), 1e-15);
  const auto centre = jets_at<3, 5>(Tangle{}, at);
  for (int c = 0; c < 3; ++c) {
    const auto right = jets_at<3, 5>(Tangle{}, Point<3>(at + step * Point<3>::Unit(c)));
    const auto left = jets_at<3, 5>(Tangle{}, Point<3>(at - step * Point<3>::Unit(c)));
    for (MultiIndex<3> alpha : Derivatives<3>::between_orders(0, 4)) {
      const double difference = (right.derivative(alpha) - left.derivative(alpha)) / (2 * step);
      alpha[c] += 1;
      EXPECT_NEAR(centre.derivative(alpha), difference,
                  difference_error * std::max(1.0, std::abs(difference)))
          << name_of<3>(alpha);
    }
  }
}

TEST(ExactDerivatives, ComeInTheOrderAskedForAtEverySize) {
  const auto function = [](const auto& p) { return exp(2.0 * p[0]) * sin(p[1]); };
  const Point<2> at(0.2, 0.5);
  for (int order = 0; order <= 8; ++order) {
    const Derivatives<2> wanted{{order, 0}, {0, order}, {0, 0}};
    const Eigen::VectorXd values = exact_derivatives<2>(function, at, wanted);
    ASSERT_EQ(values.size(), wanted.size());
    for (int i = 0; i < wanted.size(); ++i) {
      const double expected =
          std::pow(2, wanted[i][0]) * std::exp(2 * at[0]) * sine_derivative(wanted[i][1], 1, at[1]);
      EXPECT_NEAR(values[i], expected, tolerance<2>(wanted[i], expected)) << name_of<2>(wanted[i]);
    }
  }
}

TEST(ExactDerivatives, RefuseOrdersAboveEight) {
  const auto function = [](const auto& p) { return exp(p[0]); };
  EXPECT_THROW((void)exact_derivatives<1>(function, Point<1>(1.0), {{9}}), std::logic_error);
}

TEST(ExactDerivatives, GiveSeveralFieldsThroughAnArray) {
  const auto fields = [](const auto& p) { return std::array{p[0] * p[1], p[0] - p[1]}; };
  const auto jets = jets_at<2, 2>(fields, Point<2>(3, 5));
  EXPECT_EQ(jets[0].derivative({1, 1}), 1);
  EXPECT_EQ(jets[1].derivative({0, 1}), -1);
}

}  // namespace
}  // namespace strongpoint
