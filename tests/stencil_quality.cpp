#include "studies/support/stencil_quality.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "problems/core/layout.hpp"

namespace strongpoint {
namespace {

/// Round-off of a handful of operations on numbers of order one.
constexpr double round_off = 1e-13;

template <int Dim>
struct Case {
  std::unique_ptr<Method<Dim>> method;
  Discretisation<Dim> scene;
};

/// A method's weights of first and second derivatives on a grid of the unit cube.
template <int Dim>
Case<Dim> on_grid(const std::string& method, const std::string& stencil, int level) {
  const CaseKey key{"field", method, stencil, "grid", "collocation", "umfpack", level};
  const UnitCube<Dim> domain;
  Choices<Dim> choices(key);
  Case<Dim> result;
  result.scene.derivatives = Derivatives<Dim>::between_orders(1, 2);
  result.scene.cloud = make_case_cloud<Dim>(domain, key, {});
  result.scene.sites = sites_of_cloud<Dim>(result.scene.cloud);
  StageTimes times;
  compute_weights<Dim>(result.scene, domain, choices, {}, StageClock(1), times);
  result.method = std::move(choices.method);
  return result;
}

TEST(StencilQuality, ConditionsOfNineNearestNodesOnAGridAreThoseOfTheNotes) {
  const auto [method, scene] = on_grid<2>("mfpm", "nearest[k=9]", 11);
  const PerAnchor condition =
      stencil_conditions<2>(scene, *method, Scaling::both, ConditionNorm::two);
  ASSERT_EQ(condition.reason, "");
  // The notes give three digits.
  EXPECT_NEAR(condition.values[5 * 11 + 5], 12.0, round_off * 12);
  EXPECT_NEAR(condition.values[5], 79.5, 0.05);
  EXPECT_NEAR(condition.values[0], 334, 0.5);
}

TEST(StencilQuality, ThreePointDifferencesHaveTheirKnownLebesgueNumbersAndCentres) {
  constexpr int level = 9;
  const auto [method, scene] = on_grid<1>("mfpm", "star[per_sector=1]", level);
  // The spacing of a table counts nodes, the distance between nodes counts gaps.
  const double spacings = (level - 1.0) / level;
  const PerAnchor first = lebesgue_numbers<1>(scene, 1);
  const PerAnchor second = lebesgue_numbers<1>(scene, 2);
  const PerAnchor centre = laplacian_centres<1>(scene);
  const PerAnchor size = stencil_sizes<1>(scene, *method);
  // (-1/2, 0, 1/2) and (1, -2, 1) inside, (-3/2, 2, -1/2) and the same (1, -2, 1) at an end, where
  // the own node's 1 is a quarter of the absolute sum and of the wrong sign.
  for (const int end : {0, level - 1}) {
    EXPECT_NEAR(first.values[end], 4 * spacings, round_off);
    EXPECT_NEAR(second.values[end], 4 * spacings * spacings, round_off);
    EXPECT_NEAR(centre.values[end], 0.25, round_off);
  }
  for (int i = 1; i < level - 1; ++i) {
    EXPECT_NEAR(first.values[i], spacings, round_off);
    EXPECT_NEAR(second.values[i], 4 * spacings * spacings, round_off);
    EXPECT_NEAR(centre.values[i], -0.5, round_off);
    EXPECT_EQ(size.values[i], 3);
  }
}

TEST(StencilQuality, ResidualIsRoundOffAndTellsWeightsThatAreSpoilt) {
  auto [method, scene] = on_grid<1>("mfpm", "star[per_sector=1]", 9);
  for (const double residual : reproduction_residuals<1>(scene, 2).values) {
    EXPECT_LT(residual, round_off);
  }
  // All weights too large by a thousandth: with z = -1, 0, 1 the first derivative has the absolute
  // sum 1.001 and makes 1.001 of 1; the second has 4.004 and makes 2.002 of 2, which is half as
  // bad.
  for (double& value : scene.weights.values) value *= 1.001;
  EXPECT_NEAR(reproduction_residuals<1>(scene, 2).values[4], 1e-3 / 1.001, round_off);
  EXPECT_NEAR(reproduction_residuals<1>(scene, 0).values[4], 0, round_off);
}

TEST(StencilQuality, ResidualOfAFitShowsTheDegreeItDoesNotReproduce) {
  const auto [method, scene] = on_grid<2>("lsfdm", "nearest[k=15]", 9);
  for (const double residual : reproduction_residuals<2>(scene, 2).values) {
    EXPECT_LT(residual, 1e-12);  // the condition of a corner's stencil is a few hundred
  }
  EXPECT_GT(reproduction_residuals<2>(scene, 3).values[0], 1e-3);
}

TEST(StencilQuality, WhatAMethodDoesNotGiveIsAReason) {
  auto [method, scene] = on_grid<2>("mfpm", "nearest[k=9]", 5);
  scene.derivatives = Derivatives<2>{{1, 0}, {0, 1}};
  scene.weights = method->weights(scene.sites, scene.stencils, scene.derivatives);
  EXPECT_EQ(lebesgue_numbers<2>(scene, 1).reason, "");
  EXPECT_NE(lebesgue_numbers<2>(scene, 2).reason, "");
  EXPECT_NE(laplacian_centres<2>(scene).reason, "");
  EXPECT_NE(reproduction_residuals<2>(scene, -1).reason, "");
}

TEST(StencilQuality, AnchorsWithoutAStencilHaveNoNumber) {
  auto [method, scene] = on_grid<2>("mfpm", "nearest[k=9]", 5);
  scene.sites.wanted[3] = 0;
  const PerAnchor condition =
      stencil_conditions<2>(scene, *method, Scaling::row, ConditionNorm::one);
  EXPECT_TRUE(std::isnan(condition.values[3]));
  EXPECT_TRUE(std::isfinite(condition.values[4]));
}

TEST(StencilQuality, SpreadTakesTheNearestRankAndBearsInfinity) {
  std::vector<double> values;
  for (int i = 200; i >= 1; --i) values.push_back(i);
  const Spread spread = spread_of(values);
  EXPECT_EQ(spread.least, 1);
  EXPECT_EQ(spread.median, 100);
  EXPECT_EQ(spread.p99, 198);
  EXPECT_EQ(spread.most, 200);
  const Spread bad = spread_of({std::numeric_limits<double>::infinity(), 2, 1});
  EXPECT_EQ(bad.median, 2);
  EXPECT_TRUE(std::isinf(bad.most));
  EXPECT_THROW(spread_of({}), std::invalid_argument);
}

TEST(StencilQuality, LimitOfAGrowingRuleIsFoundInsideAZonedOne) {
  EXPECT_FALSE(condition_limit("nearest[k=9]", Zone::interior));
  const auto plain = condition_limit("grow_until", Zone::boundary);
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->most, 1e3);
  EXPECT_EQ(plain->scaling, Scaling::both);
  EXPECT_EQ(plain->norm, ConditionNorm::two);
  const std::string zoned =
      "zoned[interior=star,boundary=grow_until[cond_max=4e8,scaling=row,norm=one]]";
  EXPECT_FALSE(condition_limit(zoned, Zone::interior));
  const auto boundary = condition_limit(zoned, Zone::boundary);
  ASSERT_TRUE(boundary);
  EXPECT_EQ(boundary->most, 4e8);
  EXPECT_EQ(boundary->scaling, Scaling::row);
  EXPECT_EQ(boundary->norm, ConditionNorm::one);
}

}  // namespace
}  // namespace strongpoint
