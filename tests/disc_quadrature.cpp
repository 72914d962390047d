// Gauss-Legendre rules, and quadrature over discs that the boundary of a domain cuts.
#include "problems/core/disc_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "problems/core/layout.hpp"
#include "problems/core/problem.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;
using std::numbers::pi;

constexpr DiscCounts default_counts{6, 12};

TEST(GaussLegendre, IsExactForPolynomialsUpToDegree2nMinus1AndNoFurther) {
  for (int n = 1; n <= 20; ++n) {
    const LineRule rule = gauss_legendre(n);
    const auto error = [&](int degree) {
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += rule.weight[i] * std::pow(rule.at[i], degree);
      return std::abs(sum - 1.0 / (degree + 1));
    };
    for (int degree = 0; degree < 2 * n; ++degree) EXPECT_LT(error(degree), 1e-14) << n;
    if (n <= 8) {
      EXPECT_GT(error(2 * n), 1e-12) << n;
    }
    EXPECT_TRUE(std::is_sorted(rule.at.begin(), rule.at.end()));
  }
}

double area_of(const DiscRule& rule) {
  double sum = 0;
  for (const AreaPoint& point : rule.area) sum += point.weight;
  return sum;
}

double length_of(const DiscRule& rule) {
  double sum = 0;
  for (const EdgePoint& point : rule.edge) sum += point.weight;
  return sum;
}

/// Area of a circle of radius r beyond a line at distance d from its centre.
double cap_area(double r, double d) {
  return r * r * std::acos(d / r) - d * std::sqrt(r * r - d * d);
}

TEST(DiscQuadrature, IntegratesPolynomialsOverWholeDiscs) {
  const UnitCube<2> square;
  const DiscRule rule = DiscQuadrature(square, default_counts).whole({0.4, 0.6}, 0.2);
  double fourth = 0;  // of x^2 y^2 about the centre: pi r^6 / 24
  for (const AreaPoint& point : rule.area) {
    const Point2 z = point.x - Point2(0.4, 0.6);
    fourth += point.weight * z[0] * z[0] * z[1] * z[1];
  }
  EXPECT_NEAR(area_of(rule), pi * 0.04, 1e-15);
  EXPECT_NEAR(fourth, pi * std::pow(0.2, 6) / 24, 1e-17);
  EXPECT_EQ(rule.area.size(), 72U);
}

TEST(DiscQuadrature, HalvesDiscsAtEdgesAndQuartersThemAtCorners) {
  const UnitCube<2> square;
  const DiscQuadrature quadrature(square, default_counts);
  const DiscRule edge = quadrature.cut({0.3, 0}, 0.1);
  EXPECT_NEAR(area_of(edge), pi * 0.01 / 2, 1e-14);
  EXPECT_NEAR(length_of(edge), 0.2, 1e-12);
  const DiscRule corner = quadrature.cut({1, 1}, 0.1);
  EXPECT_NEAR(area_of(corner), pi * 0.01 / 4, 1e-14);
  EXPECT_NEAR(length_of(corner), 0.2, 1e-12);
  for (const AreaPoint& point : corner.area) EXPECT_LT(square.distance(point.x), 0);
  // The rim passes through a corner: whatever the round-off, the disc is a half.
  for (const double x : {0.05, 0.1, 0.15, 0.3}) {
    EXPECT_NEAR(area_of(quadrature.cut({x, 0}, x)), pi * x * x / 2, 1e-12) << x;
  }
}

TEST(DiscQuadrature, CutsDiscsByASecondSide) {
  const UnitCube<2> square;
  constexpr double r = 0.1;
  for (const double d : {0.02, 0.05, 0.09}) {  // the node's distance from the corner
    const DiscRule rule = DiscQuadrature(square, default_counts).cut({d, 0}, r);
    EXPECT_NEAR(area_of(rule), (pi * r * r - cap_area(r, d)) / 2, 1e-14) << d;
    EXPECT_NEAR(length_of(rule), r + d + std::sqrt(r * r - d * d), 1e-12) << d;
  }
  const DiscRule inside = DiscQuadrature(square, default_counts).cut({0.5, 0.08}, r);
  EXPECT_NEAR(area_of(inside), pi * r * r - cap_area(r, 0.08), 1e-14);
  EXPECT_NEAR(area_of(DiscQuadrature(square, default_counts).cut({0.5, 0.5}, 1)), 1, 1e-14);
}

/// A chord shorter than an eighth of the radius cuts off at most (2/3) (1/8) (1/512) of radius^2.
TEST(DiscQuadrature, MissesAtMostASliverOfASideThatGrazesTheDisc) {
  const UnitCube<2> square;
  constexpr double r = 0.1;
  for (int i = 1; i < 100; ++i) {
    const double d = r * (1 - 1e-4 * i);
    const double area = area_of(DiscQuadrature(square, default_counts).cut({0.437, d}, r));
    EXPECT_NEAR(area, pi * r * r - cap_area(r, d), 1.7e-4 * r * r) << d;
  }
}

/// The domain of plate_hole with a hole of radius 0.2.
const Domain<2>& plate_domain() {
  static const NamedProblem plate = make_problem("plate_hole");
  return std::get<1>(plate.made)->domain();
}

TEST(DiscQuadrature, CutsDiscsByTheHoleOfThePlate) {
  constexpr double a = 0.2;
  for (const double r : {0.01, 0.03, 0.06}) {
    const Point2 node = a * Point2(std::cos(0.7), std::sin(0.7));
    const DiscRule rule = DiscQuadrature(plate_domain(), default_counts).cut(node, r);
    // A lens: the discs of radius r about the node and of radius a about the origin.
    const double half = std::acos(r / (2 * a));  // angle at the node
    const double lens =
        r * r * half + a * a * (pi - 2 * half) - a * r * std::sqrt(1 - r * r / (4 * a * a));
    EXPECT_NEAR(area_of(rule), pi * r * r - lens, 1e-10 * r * r) << r;
    EXPECT_NEAR(length_of(rule), 4 * a * std::asin(r / (2 * a)), 1e-10 * r) << r;
    for (const AreaPoint& point : rule.area) {
      EXPECT_LT(plate_domain().distance(point.x), r * r / (2 * a));
    }
  }
}

/// int div(v F) = int_edge v F.n for the form's test function v and a cubic field F.
TEST(DiscQuadrature, SatisfiesTheDivergenceTheoremOnEveryBoundaryNode) {
  const UnitCube<2> square;
  for (const Domain<2>* domain : std::vector<const Domain<2>*>{&square, &plate_domain()}) {
    const PointCloud<2> cloud = make_cloud<2>(*domain, "grid", LayoutRequest{11, 1});
    const DiscQuadrature quadrature(*domain, default_counts);
    for (int i = 0; i < cloud.size(); ++i) {
      if (!cloud.is_boundary(i)) continue;
      const double r = 0.03;
      const Point2 centre = cloud.nodes.col(i);
      const DiscRule rule = quadrature.cut(centre, r);
      double balance = 0;
      double magnitude = 0;
      for (const AreaPoint& p : rule.area) {
        const Point2 z = (p.x - centre) / r;
        const double t = z.norm();
        const double v = 1 - 6 * t * t + 8 * t * t * t - 3 * t * t * t * t;
        const Point2 flux(1 + z[0] * z[1], 2 - z[1] * z[1] * z[0]);
        const double divergence = z[1] - 2 * z[1] * z[0];
        const double term = v * divergence - 12 * (1 - t) * (1 - t) * z.dot(flux);
        balance += p.weight / r * term;
        magnitude += std::abs(p.weight / r * term);
      }
      for (const EdgePoint& p : rule.edge) {
        const Point2 z = (p.x - centre) / r;
        const double t = z.norm();
        const double v = 1 - 6 * t * t + 8 * t * t * t - 3 * t * t * t * t;
        const Point2 flux(1 + z[0] * z[1], 2 - z[1] * z[1] * z[0]);
        balance -= p.weight * v * flux.dot(domain->normal(p.side, p.x));
      }
      EXPECT_LT(std::abs(balance), 1e-6 * magnitude) << i << ' ' << centre.transpose();
    }
  }
}

}  // namespace
}  // namespace strongpoint
