// Maximum-entropy functions: constraints, derivatives, faces, second order.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Residual of the moments: Newton's method stops at 1e-13 in units of the spacing.
constexpr double moment_tolerance = 1e-10;
/// Central differences with this step, in units of the spacing, of functions whose third derivative
/// is of order ten: a truncation error of about 1e-7, round-off 1e-9.
constexpr double step = 1e-4;
constexpr double difference_tolerance = 1e-6;

/// sum_a p_a f(x_a - x) at the only point of some weights.
template <int Dim, class Function>
double moment(const TestScene<Dim>& scene, const Weights& weights, int derivative,
              const Point<Dim>& x, Function f) {
  double sum = 0;
  for (std::size_t j = 0; j < weights.nodes(0).size(); ++j) {
    sum += weights.row(0)(derivative, static_cast<Eigen::Index>(j)) *
           f(Point<Dim>(scene.sites.nodes.col(weights.nodes(0)[j]) - x));
  }
  return sum;
}

/// A point near a node, within the unit cube.
template <int Dim>
Point<Dim> beside(const TestScene<Dim>& scene, int anchor) {
  const Point<Dim> centre = Point<Dim>::Constant(0.48);
  return scene.sites.anchors.col(anchor) + 0.06 * (centre - scene.sites.anchors.col(anchor));
}

template <int Dim>
void check_distribution(const std::string& spec, const std::string& cloud, int level) {
  const TestScene<Dim> scene = make_scene<Dim>(spec, cloud, level, 1);
  const Derivatives<Dim> value = Derivatives<Dim>::between_orders(0, 0);
  for (int a = 0; a < scene.sites.anchor_count(); a += Dim == 3 ? 7 : 3) {
    for (const Point<Dim>& x : {Point<Dim>(scene.sites.anchors.col(a)), beside(scene, a)}) {
      const Weights p = weights_at<Dim>(scene, a, x, value);
      EXPECT_GE(p.row(0).minCoeff(), 0) << spec << " on " << cloud << " at node " << a;
      EXPECT_NEAR(p.row(0).sum(), 1, 1e-14) << spec << " on " << cloud << " at node " << a;
      for (int c = 0; c < Dim; ++c) {
        EXPECT_NEAR(moment<Dim>(scene, p, 0, x, [&](const Point<Dim>& y) { return y[c]; }), 0,
                    moment_tolerance)
            << spec << " on " << cloud << " at node " << a;
      }
    }
  }
}

TEST(MaxEntropy, FunctionsAreNonNegativeSumToOneAndReproduceLinearFields) {
  for (const char* cloud : {"grid", "perturbed[amount=0.3]", "random", "scattered"}) {
    check_distribution<1>("max_ent", cloud, 13);
    check_distribution<2>("max_ent", cloud, 11);
    check_distribution<3>("max_ent", cloud, 7);
    check_distribution<1>("max_ent[order=2]", cloud, 13);
    check_distribution<2>("max_ent[order=2]", cloud, 11);
  }
  check_distribution<1>("max_ent[boundary=bspline]", "grid", 31);
  check_distribution<1>("max_ent[order=2,boundary=bspline]", "perturbed[amount=0.2]", 31);
}

template <int Dim>
void check_derivatives(const std::string& spec, const std::string& cloud, int level, int anchor) {
  const TestScene<Dim> scene = make_scene<Dim>(spec, cloud, level, 1);
  const double h = scene.sites.spacing[anchor];
  const Point<Dim> x = beside(scene, anchor);
  const auto all = Derivatives<Dim>::between_orders(0, 2);
  const Eigen::MatrixXd exact = weights_at<Dim>(scene, anchor, x, all).row(0);
  for (int i = 0; i < Dim; ++i) {
    Points<Dim> sides(Dim, 2);
    sides.col(0) = x + step * h * Point<Dim>::Unit(i);
    sides.col(1) = x - step * h * Point<Dim>::Unit(i);
    const Weights near = weights_at<Dim>(scene, anchor, sides, all);
    const Eigen::MatrixXd rate = (near.row(0) - near.row(1)) / (2 * step);  // times h
    for (int d = 0; d < all.size(); ++d) {
      MultiIndex<Dim> higher = all[d];
      ++higher[i];
      if (order_of<Dim>(higher) > 2) continue;
      const double unit = std::pow(h, order_of<Dim>(all[d]));
      const Eigen::VectorXd error =
          unit * (rate.row(d) - h * exact.row(all.index(higher))).transpose();
      EXPECT_LT(error.cwiseAbs().maxCoeff(), difference_tolerance)
          << spec << " at node " << anchor << ", " << name_of<Dim>(higher);
    }
  }
}

TEST(MaxEntropy, DerivativesAreThoseOfTheFunctions) {
  for (const char* cloud : {"grid", "perturbed[amount=0.3]"}) {
    for (const char* spec : {"max_ent", "max_ent[beta=1.8]", "max_ent[order=2]"}) {
      check_derivatives<1>(spec, cloud, 13, 6);
      check_derivatives<1>(spec, cloud, 13, 1);
      check_derivatives<2>(spec, cloud, 11, 60);
    }
    check_derivatives<3>("max_ent", cloud, 7, 171);
  }
}

/// Within half a spacing of the end the gap changes, and with it its derivatives.
TEST(MaxEntropy, DerivativesOfSecondOrderIncludeThoseOfTheGapAtAnEnd) {
  check_derivatives<1>("max_ent[order=2]", "grid", 13, 0);
  check_derivatives<1>("max_ent[order=2]", "perturbed[amount=0.3]", 13, 12);
}

TEST(MaxEntropy, DerivativesOfTheBlendAreThoseOfItsFunctions) {
  for (const char* spec : {"max_ent[boundary=bspline]", "max_ent[order=2,boundary=bspline]"}) {
    for (int anchor : {1, 2, 3, 4, 29}) {
      check_derivatives<1>(spec, "grid", 31, anchor);
      check_derivatives<1>(spec, "perturbed[amount=0.2]", 31, anchor);
    }
  }
}

TEST(MaxEntropy, FunctionsOnAFaceBelongToItsNodesAndAVertexHasItsOwn) {
  const TestScene<2> scene = make_scene<2>("max_ent", "perturbed[amount=0.3]", 9, 1);
  const Weights p = scene.method->weights(scene.sites, scene.stencils, {{0, 0}});
  int on_edges = 0;
  int at_corners = 0;
  for (int i = 0; i < p.size(); ++i) {
    const Point<2> x = scene.sites.points.col(i);
    for (int c = 0; c < 2; ++c) {
      if (x[c] != 0 && x[c] != 1) continue;
      ++on_edges;
      for (std::size_t j = 0; j < p.nodes(i).size(); ++j) {
        const double weight = p.row(i)(0, static_cast<Eigen::Index>(j));
        if (scene.sites.nodes(c, p.nodes(i)[j]) != x[c]) {
          EXPECT_EQ(weight, 0);
        } else if (x[1 - c] == 0 || x[1 - c] == 1) {
          at_corners += p.nodes(i)[j] == i ? 1 : 0;
          EXPECT_EQ(weight, p.nodes(i)[j] == i ? 1 : 0);
        }
      }
    }
  }
  EXPECT_EQ(on_edges, 4 * 9);
  EXPECT_EQ(at_corners, 2 * 4);  // once for each of its edges
}

/// The functions on an edge of the square are those of a line of the same nodes.
TEST(MaxEntropy, FunctionsOnAnEdgeAreThoseOfItsOwnDimension) {
  const TestScene<2> square = make_scene<2>("max_ent", "grid", 11, 1);
  TestScene<1> line = make_scene<1>("max_ent", "grid", 11, 1);
  line.sites.spacing.setConstant(square.sites.spacing[5]);
  const Weights on_edge = square.method->weights(square.sites, square.stencils, {{0, 0}});
  const Weights on_line = line.method->weights(line.sites, line.stencils, {{0}});
  for (std::size_t j = 0; j < on_line.nodes(5).size(); ++j) {
    const int node = on_line.nodes(5)[j];  // (0, node) on the square
    const auto nodes = on_edge.nodes(5);
    const auto found = std::find(nodes.begin(), nodes.end(), node);
    ASSERT_NE(found, nodes.end());
    EXPECT_NEAR(on_edge.row(5)(0, found - nodes.begin()),
                on_line.row(5)(0, static_cast<Eigen::Index>(j)), moment_tolerance);
  }
}

TEST(MaxEntropy, PointsOutsideTheConvexHullAreRefused) {
  const TestScene<2> scene = make_scene<2>("max_ent", "grid", 9, 1);
  for (const Point<2>& outside : {Point<2>(-1e-6, 0.5), Point<2>(-0.05, -0.02)}) {
    const int anchor = outside[1] > 0 ? 4 : 0;
    EXPECT_THROW(weights_at<2>(scene, anchor, outside, {{0, 0}}), CaseError);
  }
}

/// On an equidistant line without ends the functions are Gauss bells but for their sum; at half a
/// spacing and at nodes they are symmetric, so that lambda vanishes.
TEST(MaxEntropy, FunctionsOnALineAreNormalisedGaussBells) {
  const TestScene<1> scene = make_scene<1>("max_ent[beta=1.2]", "grid", 21, 1);
  const Weights p = scene.method->weights(scene.sites, scene.stencils, {{0}});
  const auto nodes = p.nodes(10);
  double sum = 0;
  for (int node : nodes) sum += std::exp(-1.2 * (node - 10) * (node - 10));
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    EXPECT_NEAR(p.row(10)(0, static_cast<Eigen::Index>(j)),
                std::exp(-1.2 * (nodes[j] - 10) * (nodes[j] - 10)) / sum, 1e-13);
  }
}

/// With beta to infinity only the corners of the Delaunay triangle remain.
TEST(MaxEntropy, FunctionsOfLargeLocalityAreThoseOfTheSimplexAroundThePoint) {
  const TestScene<1> line = make_scene<1>("max_ent[beta=10]", "grid", 9, 1);
  const Weights p = weights_at<1>(line, 4, Points<1>::Constant(1, 1, 0.5 + 0.03), {{0}});
  for (std::size_t j = 0; j < p.nodes(0).size(); ++j) {
    const double distance = std::abs(line.sites.nodes(0, p.nodes(0)[j]) - 0.53);
    EXPECT_NEAR(p.row(0)(0, static_cast<Eigen::Index>(j)), std::max(0.0, 1 - 8 * distance), 1e-3);
  }
}

TEST(MaxEntropy, SecondMomentOfSecondOrderIsTheGap) {
  for (const char* cloud : {"grid", "perturbed[amount=0.3]"}) {
    const TestScene<1> scene = make_scene<1>("max_ent[order=2]", cloud, 15, 1);
    for (int a = 0; a < 15; ++a) {
      const Point<1> x = beside(scene, a);
      double widest = 0;
      const auto nodes = scene.stencils[a];
      std::vector<double> at;
      for (int node : nodes) at.push_back(scene.sites.nodes(0, node));
      std::sort(at.begin(), at.end());
      for (std::size_t i = 1; i < at.size(); ++i) widest = std::max(widest, at[i] - at[i - 1]);
      const bool is_left = x[0] - at.front() < at.back() - x[0];
      const double end = is_left ? x[0] - at.front() : at.back() - x[0];
      const double last = is_left ? at[1] - at[0] : at.back() - at[at.size() - 2];
      const double left = std::max(0.0, 1 - end / std::min(widest / 2, last));
      const Weights p = weights_at<1>(scene, a, x, {{0}});
      EXPECT_NEAR(moment<1>(scene, p, 0, x, [](const Point<1>& y) { return y[0] * y[0]; }),
                  0.6 * widest * widest * (1 - left * left), moment_tolerance);
    }
  }
}

template <int Dim>
void check_quadratics(const std::string& cloud) {
  const TestScene<Dim> scene = make_scene<Dim>("max_ent[order=2]", cloud, 11, 1);
  const Derivatives<Dim> derivatives = Derivatives<Dim>::between_orders(1, 2);
  const Weights weights = scene.method->weights(scene.sites, scene.stencils, derivatives);
  for (int i = 0; i < weights.size(); ++i) {
    for (int d = 0; d < derivatives.size(); ++d) {
      for (const MultiIndex<Dim>& alpha : Derivatives<Dim>::between_orders(1, 2)) {
        double sum = 0;
        double magnitude = 0;
        for (std::size_t j = 0; j < weights.nodes(i).size(); ++j) {
          const double term =
              weights.row(i)(d, static_cast<Eigen::Index>(j)) *
              monomial<Dim>(scene.sites.nodes.col(weights.nodes(i)[j]) - scene.sites.points.col(i),
                            alpha);
          sum += term;
          magnitude += std::abs(term);
        }
        const double exact = alpha == derivatives[d] ? factorial<Dim>(alpha) : 0;
        EXPECT_LT(std::abs(sum - exact), 1e-9 * (1 + magnitude)) << cloud << " at node " << i;
      }
    }
  }
}

TEST(MaxEntropy, DerivativesOfSecondOrderAreExactForQuadraticsAtEveryNode) {
  for (const char* cloud : {"grid", "perturbed[amount=0.2]", "perturbed[amount=0.4]"}) {
    check_quadratics<1>(cloud);
    check_quadratics<2>(cloud);
  }
}

TEST(MaxEntropy, MirroredNodesHaveMirroredFunctions) {
  for (const char* spec : {"max_ent", "max_ent[order=2]", "max_ent[boundary=bspline]"}) {
    const TestScene<1> scene = make_scene<1>(spec, "grid", 31, 1);
    const Weights w = scene.method->weights(scene.sites, scene.stencils, {{0}, {1}, {2}});
    for (int i = 0; i < 16; ++i) {
      ASSERT_EQ(w.nodes(i).size(), w.nodes(30 - i).size());
      for (std::size_t j = 0; j < w.nodes(i).size(); ++j) {
        const auto nodes = w.nodes(30 - i);
        const auto found = std::find(nodes.begin(), nodes.end(), 30 - w.nodes(i)[j]);
        ASSERT_NE(found, nodes.end());
        for (int d = 0; d < 3; ++d) {
          const double sign = d == 1 ? -1 : 1;
          EXPECT_NEAR(w.row(i)(d, static_cast<Eigen::Index>(j)),
                      sign * w.row(30 - i)(d, found - nodes.begin()), 1e-9 * std::pow(31, d))
              << spec << " at node " << i;
        }
      }
    }
  }
}

TEST(MaxEntropy, WhatDoesNotExistSaysWhy) {
  EXPECT_NE(make_method<3>("max_ent[order=2]").made->unsupported({}), "");
  EXPECT_NE(make_method<2>("max_ent[boundary=bspline]").made->unsupported({}), "");
  EXPECT_NE(make_method<3>("max_ent[boundary=bspline]").made->unsupported({}), "");
  EXPECT_EQ(make_method<2>("max_ent[order=2]").made->unsupported({}), "");
}

}  // namespace
}  // namespace strongpoint
