// Exact solutions and data of the elasticity problems.
#include <cmath>

#include <gtest/gtest.h>

#include "problems/core/jet.hpp"
#include "problems/core/radial_lame.hpp"

namespace strongpoint {
namespace {

/// Round-off of sums of second derivatives of size 100.
constexpr double stress_tolerance = 1e-10;

/// Displacement gradient, gradient(i, j) = d u_i / d x_j, of jets.
template <int Dim, int Order>
Eigen::Matrix<double, Dim, Dim> gradient_of(const std::array<Jet<Dim, Order>, Dim>& u) {
  Eigen::Matrix<double, Dim, Dim> gradient;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) gradient(i, j) = u[i].derivative(partial<Dim>(j));
  }
  return gradient;
}

/// Component i of div sigma from second derivatives.
template <int Dim>
double divergence_of_stress(const Lame& material, const std::array<Jet<Dim, 2>, Dim>& u, int i) {
  double sum = 0;
  for (int j = 0; j < Dim; ++j) {
    sum += material.mu * u[i].derivative(partial<Dim>(j, j)) +
           (material.lambda + material.mu) * u[j].derivative(partial<Dim>(i, j));
  }
  return sum;
}

template <int Dim>
void expect_lame(double a, double b, const Point<Dim>& direction) {
  const Lame material = lame_constants(1000, 0.3);
  const RadialLame<Dim> exact(a, b, 2, material);
  const Point<Dim> n = direction.normalized();
  for (const double r : {a, 0.5 * (a + b), b}) {
    const auto u = jets_at<Dim, 2>(exact, Point<Dim>(r * n));
    for (int i = 0; i < Dim; ++i) {
      EXPECT_NEAR(divergence_of_stress<Dim>(material, u, i), 0, stress_tolerance);
    }
    const auto sigma = stress<Dim>(material, gradient_of<Dim, 2>(u));
    const double inner = std::pow(a, Dim), outer = std::pow(b, Dim), here = std::pow(r, Dim);
    // Timoshenko and Goodier's stresses: -p at a, 0 at b, and the hoop stress.
    const double load = 2 * inner / (outer - inner);
    const double radial = load * (1 - outer / here);
    const double hoop = load * (1 + outer / (here * (Dim - 1)));
    EXPECT_NEAR(n.dot(sigma * n), radial, stress_tolerance);
    EXPECT_NEAR(sigma.trace() - n.dot(sigma * n), (Dim - 1) * hoop, stress_tolerance);
    EXPECT_NEAR((sigma * n - radial * n).norm(), 0, stress_tolerance);
  }
}

TEST(RadialLame, IsInEquilibriumUnderPressureInside) {
  expect_lame<2>(1, 4, {2, 1});
  expect_lame<3>(1, 2, {2, 1, 3});
}

}  // namespace
}  // namespace strongpoint
