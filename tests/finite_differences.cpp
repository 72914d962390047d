// Finite differences on structured clouds: closed forms, orders, and what becomes of them off
// grids.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "methods/core/fornberg.hpp"
#include "methods/core/index_differences.hpp"
#include "studies/support/run_case.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Round-off of weights, relative to the largest.
constexpr double round_off = 1e-12;

/// Weights of one derivative at one point by node id.
std::map<int, double> weights_by_node(const Weights& weights, int point, int derivative) {
  std::map<int, double> result;
  const std::span<const int> nodes = weights.nodes(point);
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    result[nodes[j]] = weights.row(point)(derivative, static_cast<Eigen::Index>(j));
  }
  return result;
}

void expect_equal(const std::map<int, double>& weights, const std::map<int, double>& expected) {
  double scale = 0;
  for (const auto& [node, weight] : expected) scale = std::max(scale, std::abs(weight));
  for (const auto& [node, weight] : weights) {
    const auto place = expected.find(node);
    EXPECT_NEAR(weight, place == expected.end() ? 0 : place->second, round_off * scale) << node;
  }
  for (const auto& [node, weight] : expected) EXPECT_TRUE(weights.contains(node)) << node;
}

TEST(FiniteDifferences, WeightsAlongALineAreThoseOfTheTables) {
  const std::array<double, 9> nodes{-4, -3, -2, -1, 0, 1, 2, 3, 4};
  const Eigen::MatrixXd weights = fornberg_weights(nodes, 0, 2);
  // Source: Fornberg 1988, table 1.
  const std::array<double, 9> first{1.0 / 280, -4.0 / 105, 0.2,       -0.8,      0,
                                    0.8,       -0.2,       4.0 / 105, -1.0 / 280};
  const std::array<double, 9> second{-1.0 / 560, 8.0 / 315, -0.2,      1.6,       -205.0 / 72,
                                     1.6,        -0.2,      8.0 / 315, -1.0 / 560};
  for (int j = 0; j < 9; ++j) {
    EXPECT_NEAR(weights(0, j), j == 4 ? 1 : 0, 1e-14);
    EXPECT_NEAR(weights(1, j), first.at(j), 1e-14);
    EXPECT_NEAR(weights(2, j), second.at(j), 1e-14);
  }
  const Eigen::MatrixXd one_sided = fornberg_weights(std::span(nodes).subspan(4, 4), 0, 2);
  EXPECT_LT((one_sided.row(2) - Eigen::RowVector4d(2, -5, 4, -1)).norm(), 1e-13);
}

TEST(FiniteDifferences, OfOrder2OnAGridAreTheFivePointStar) {
  const TestScene<2> scene = make_scene<2>("fdm", "grid", 11, 1);
  const Weights weights = scene.method->weights(scene.sites, scene.stencils, {{2, 0}, {0, 2}});
  const int centre = 5 * 11 + 4;
  EXPECT_EQ(weights.nodes(centre).size(), 5U);
  expect_equal(weights_by_node(weights, centre, 0),
               {{centre, -200}, {centre - 11, 100}, {centre + 11, 100}});
  expect_equal(weights_by_node(weights, centre, 1),
               {{centre, -200}, {centre - 1, 100}, {centre + 1, 100}});
  EXPECT_EQ(weights.nodes(0).size(), 7U) << "one-sided along both axes at a corner";
  expect_equal(weights_by_node(weights, 0, 1), {{0, 200}, {1, -500}, {2, 400}, {3, -100}});
  const Weights mixed = scene.method->weights(scene.sites, scene.stencils, {{1, 1}});
  expect_equal(weights_by_node(mixed, centre, 0),
               {{centre - 12, 25}, {centre + 12, 25}, {centre - 10, -25}, {centre + 10, -25}});
  const Weights first = scene.method->weights(scene.sites, scene.stencils, {{1, 0}});
  expect_equal(weights_by_node(first, centre, 0), {{centre - 11, -5}, {centre + 11, 5}});
}

TEST(FiniteDifferences, KeepToTheIndexLinesOnTensorGridsOfAnySpacing) {
  for (const char* spec : {"fdm", "fdm[order=4]", "fdm[order=6]"}) {
    for (const char* cloud : {"grid", "graded[ratio=3]"}) {
      const TestScene<2> scene = make_scene<2>(spec, cloud, 31, 1);
      const Weights weights = scene.method->weights(scene.sites, scene.stencils, {{2, 0}});
      for (int p = 0; p < weights.size(); ++p) {
        for (int node : weights.nodes(p)) EXPECT_EQ(node % 31, p % 31) << spec << " on " << cloud;
      }
    }
  }
}

TEST(FiniteDifferences, StayExactDifferencesOnVeryFineGrids) {
  for (const char* spec : {"fdm", "fdm[order=4]", "fdm[order=8]"}) {
    TestScene<1> scene = make_scene<1>(spec, "grid", 20001, 1);
    scene.sites.nodes.array() += 3;
    scene.sites.anchors = scene.sites.points = scene.sites.nodes;
    const Weights weights = scene.method->weights(scene.sites, scene.stencils, {{2}});
    const std::size_t central = 1 + make_method<1>(spec).made->promises().reproduces;
    EXPECT_EQ(weights.nodes(10000).size(), central) << spec;
  }
}

/// Largest errors of first and of second derivatives of a smooth function, inside and at the
/// boundary: {first inside, first at the boundary, second inside, second at the boundary}.
template <int Dim>
std::array<double, 4> errors(const std::string& spec, const std::string& cloud, int level) {
  const TestScene<Dim> scene = make_scene<Dim>(spec, cloud, level, 1);
  const Derivatives<Dim> all = Derivatives<Dim>::between_orders(1, 2);
  const Weights weights = scene.method->weights(scene.sites, scene.stencils, all);
  std::array<double, 4> worst{};
  const auto phase = [](const Point<Dim>& x) {
    double sum = 0.3;
    for (int c = 0; c < Dim; ++c) sum += (c + 4) * x[c];
    return sum;
  };
  for (int p = 0; p < weights.size(); ++p) {
    const double at = phase(scene.cloud.nodes.col(p));
    for (int d = 0; d < all.size(); ++d) {
      double error = order_of<Dim>(all[d]) == 1 ? -std::cos(at) : std::sin(at);
      for (int c = 0; c < Dim; ++c) error *= std::pow(c + 4, all[d][c]);
      for (const auto& [node, weight] : weights_by_node(weights, p, d)) {
        error += weight * std::sin(phase(scene.cloud.nodes.col(node)));
      }
      const int place = 2 * (order_of<Dim>(all[d]) - 1) + (scene.cloud.is_boundary(p) ? 1 : 0);
      worst.at(place) = std::max(worst.at(place), std::abs(error));
    }
  }
  return worst;
}

template <int Dim>
void expect_orders(const std::string& spec, const std::string& cloud, int level,
                   const std::array<double, 4>& least) {
  const auto coarse = errors<Dim>(spec, cloud, level);
  const auto fine = errors<Dim>(spec, cloud, 2 * level - 1);
  for (std::size_t i = 0; i < least.size(); ++i) {
    // The largest error of a finite level falls a little short of the order of the limit.
    EXPECT_GT(std::log2(coarse.at(i) / fine.at(i)), least.at(i) - 0.3)
        << spec << " on " << cloud << " in " << Dim << "D, kind " << i;
  }
}

TEST(FiniteDifferences, ConvergeAtTheirOrderInsideAndAtTheBoundary) {
  for (int order = 1; order <= 8; ++order) {
    const std::string spec = "fdm[order=" + std::to_string(order) + "]";
    const double p = order;
    expect_orders<1>(spec, "grid", order + 12, {p, p, p, p});
    expect_orders<2>(spec, "grid", order + 12, {p, p, p, p});
  }
  expect_orders<3>("fdm", "grid", 9, {2, 2, 2, 2});
}

TEST(FiniteDifferences, KeepTheirOrderOnSmoothlyGradedGrids) {
  for (int order : {2, 4}) {
    const std::string spec = "fdm[order=" + std::to_string(order) + "]";
    const double p = order;
    expect_orders<2>(spec, "graded[ratio=2]", 41, {p, p, p, p});
  }
}

TEST(FiniteDifferences, SolveTheTwoPointProblemLikeMfpmOnThreeNodes) {
  for (int level : {11, 161}) {
    std::array<double, 2> error{};
    const std::array<std::pair<const char*, const char*>, 2> methods{
        {{"fdm", "block[width=4]"}, {"mfpm", "nearest[k=3]"}}};
    for (std::size_t i = 0; i < 2; ++i) {
      const CaseKey key{"bvp_1d", methods.at(i).first, methods.at(i).second,
                        "grid",   "collocation",       "umfpack",
                        level};
      error.at(i) = *run_steady_case(key, RunOptions{}).quantities[0].value;
    }
    EXPECT_NEAR(error[0], error[1], 1e-10);
  }
}

TEST(FiniteDifferences, RefuseStencilsThatAreNoIndexBlock) {
  TestScene<2> scene = make_scene<2>("fdm[order=4]", "perturbed", 14, 1);
  const auto search = make_search<2>("auto", scene.sites.nodes);
  const auto message_with = [&](const std::string& rule) -> std::string {
    scene.stencils =
        select_stencils<2>(*make_rule<2>(rule).made, scene.sites, *scene.method, *search);
    try {
      scene.method->weights(scene.sites, scene.stencils, {{1, 0}});
    } catch (const CaseError& error) {
      return error.what();
    }
    return "no error";
  };
  for (const char* rule : {"block[width=3]", "nearest[k=40]", "nearest[k=2]"}) {
    const std::string message = message_with(rule);
    EXPECT_NE(message.find("node 0"), std::string::npos) << rule << ": " << message;
    EXPECT_NE(message.find("rule block"), std::string::npos) << rule << ": " << message;
  }
  EXPECT_EQ(message_with("block[width=6]"), "no error");
  EXPECT_EQ(message_with("block[width=9]"), "no error");
}

TEST(FiniteDifferences, MayStandInAZoneBesideRowsThatHoldTheirWholeStencil) {
  const TestScene<2> zoned = make_scene<2>("zoned[interior=fdm,boundary=lsfdm]", "grid", 11, 1);
  const TestScene<2> fdm = make_scene<2>("fdm", "grid", 11, 1);
  const TestScene<2> lsfdm = make_scene<2>("lsfdm", "grid", 11, 1);
  const Derivatives<2> second{{2, 0}, {0, 2}};
  const auto weights_of = [&](const TestScene<2>& scene) {
    return scene.method->weights(scene.sites, scene.stencils, second);
  };
  const Weights both = weights_of(zoned);
  const Weights inside = weights_of(fdm);
  const Weights boundary = weights_of(lsfdm);
  ASSERT_EQ(both.size(), inside.size());
  for (int p = 0; p < both.size(); ++p) {
    const Weights& expected = zoned.cloud.is_boundary(p) ? boundary : inside;
    for (int d = 0; d < 2; ++d) {
      EXPECT_EQ(weights_by_node(both, p, d), weights_by_node(expected, p, d)) << p;
    }
  }
}

}  // namespace
}  // namespace strongpoint
