// What every stencil rule owes its callers.
#include <set>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

template <int Dim>
Stencils select(const std::string& rule, TestScene<Dim>& scene) {
  const auto search = make_search<Dim>("auto", scene.sites.nodes);
  return select_stencils<Dim>(*make_rule<Dim>(rule).made, scene.sites, *scene.method, *search);
}

template <int Dim>
void check_rule(const std::string& rule) {
  TestScene<Dim> scene = make_scene<Dim>("lsfdm", "perturbed", Dim == 3 ? 7 : 14, 2);
  const Stencils stencils = select(rule, scene);
  ASSERT_EQ(stencils.size(), scene.sites.anchor_count());
  for (int a = 0; a < stencils.size(); ++a) {
    const std::span<const int> nodes = stencils[a];
    EXPECT_EQ(nodes.empty(), scene.sites.wanted[a] == 0) << rule << " at anchor " << a;
    if (nodes.empty()) continue;
    EXPECT_EQ(nodes[0], a) << rule << ": the centre comes first";
    EXPECT_EQ(std::set<int>(nodes.begin(), nodes.end()).size(), nodes.size()) << rule;
    for (std::size_t j = 1; j < nodes.size(); ++j) {
      const double before = squared_distance(scene.sites, a, nodes[j - 1]);
      const double here = squared_distance(scene.sites, a, nodes[j]);
      EXPECT_TRUE(before < here || (before == here && nodes[j - 1] < nodes[j])) << rule;
    }
  }
  omp_set_num_threads(4);
  const Stencils again = select(rule, scene);
  omp_set_num_threads(1);
  EXPECT_EQ(stencils.nodes, again.nodes) << rule << " depends on the number of threads";

  for (Points<Dim>* points : {&scene.sites.nodes, &scene.sites.anchors, &scene.sites.points}) {
    *points = (*points * 64).array() + 16;  // a power of two: distances scale without rounding
  }
  const Stencils scaled = select(rule, scene);
  for (int a = 0; a < stencils.size(); ++a) {
    EXPECT_EQ(std::set<int>(stencils[a].begin(), stencils[a].end()),
              std::set<int>(scaled[a].begin(), scaled[a].end()))
        << rule << " is not invariant under scaling and translation";
  }
}

TEST(ContractRules, GiveSortedStencilsThatBeginWithTheCentre) {
  for (const RuleEntry& entry : rules()) {
    check_rule<1>(entry.info.name);
    check_rule<2>(entry.info.name);
    check_rule<3>(entry.info.name);
  }
}

TEST(ContractRules, NearestKeepsTiesUnlessToldToCutThem) {
  TestScene<2> scene = make_scene<2>("mfpm", "grid", 11, 1);
  const int centre = 60;
  EXPECT_EQ(select<2>("nearest[k=10]", scene)[centre].size(), 13U);
  EXPECT_EQ(select<2>("nearest[k=10,ties=cut]", scene)[centre].size(), 10U);
  EXPECT_EQ(select<2>("nearest", scene)[centre].size(), 9U);
}

TEST(ContractRules, RadiusMeasuresTheSpacingAtEdgesAndCornersToo) {
  TestScene<2> scene = make_scene<2>("mfpm", "grid", 11, 1);
  const Stencils stencils = select<2>("radius[factor=1.5,least=1]", scene);
  EXPECT_EQ(stencils[60].size(), 9U);
  EXPECT_EQ(stencils[5].size(), 6U);
  EXPECT_EQ(stencils[0].size(), 4U);
}

TEST(ContractRules, RadiusTakesNeverFewerNodesThanTheMethodNeeds) {
  TestScene<2> scene = make_scene<2>("lsfdm", "random", 14, 1);
  const Stencils stencils = select<2>("radius[factor=1.1]", scene);
  const Stencils thirty = select<2>("radius[factor=1.1,least=30]", scene);
  for (int a = 0; a < stencils.size(); ++a) {
    EXPECT_GE(static_cast<int>(stencils[a].size()), scene.method->stencil_size());
    EXPECT_GE(thirty[a].size(), 30U);
  }
}

TEST(ContractRules, StarTakesTwoNodesOfEachQuadrantAndFillsUpAtBoundaries) {
  TestScene<2> scene = make_scene<2>("gfdm", "grid", 11, 1);
  const Stencils stencils = select<2>("star", scene);
  for (int a = 0; a < stencils.size(); ++a) EXPECT_EQ(stencils[a].size(), 9U) << a;
  // On a grid each half-open quadrant owns one axis: its two nearest are the axis node and the
  // diagonal one, together the 3x3 block.
  std::set<int> block;
  for (int i : {-1, 0, 1}) {
    for (int j : {-1, 0, 1}) block.insert(60 + 11 * i + j);
  }
  EXPECT_EQ(std::set<int>(stencils[60].begin(), stencils[60].end()), block);
}

TEST(ContractRules, StarOwnsEveryHalfAxisOnceIn3D) {
  TestScene<3> scene = make_scene<3>("gfdm", "grid", 7, 1);
  const Stencils stencils = select<3>("star[per_sector=1]", scene);
  const int centre = (3 * 7 + 3) * 7 + 3;
  const std::set<int> nodes(stencils[centre].begin(), stencils[centre].end());
  for (int step : {49, 7, 1}) {
    EXPECT_TRUE(nodes.contains(centre + step));
    EXPECT_TRUE(nodes.contains(centre - step));
  }
}

TEST(ContractRules, BlockShiftsInwardsAtEdgesAndRefusesUnstructuredClouds) {
  TestScene<2> scene = make_scene<2>("mfpm", "grid", 11, 1);
  const Stencils stencils = select<2>("block", scene);
  EXPECT_EQ(std::set<int>(stencils[0].begin(), stencils[0].end()),
            (std::set<int>{0, 1, 2, 11, 12, 13, 22, 23, 24}));
  scene.sites.block.reset();
  EXPECT_THROW(select<2>("block", scene), SkipCase);
}

TEST(ContractRules, WideBlocksShrinkAtEdgesToStayCentredWhenAsked) {
  TestScene<1> scene = make_scene<1>("mfpm", "grid", 11, 1);
  const Stencils stencils = select<1>("block[width=7,ends=shrink]", scene);
  const auto nodes = [&](int a) { return std::set<int>(stencils[a].begin(), stencils[a].end()); };
  EXPECT_EQ(nodes(0), (std::set<int>{0, 1, 2}));  // what order 2 needs
  EXPECT_EQ(nodes(1), (std::set<int>{0, 1, 2}));
  EXPECT_EQ(nodes(2), (std::set<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(nodes(5), (std::set<int>{2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(nodes(10), (std::set<int>{8, 9, 10}));
}

TEST(ContractRules, GrowUntilStopsAtTheConditionOrTheCap) {
  TestScene<2> scene = make_scene<2>("mfpm", "perturbed[amount=0.4]", 15, 1);
  const Stencils base = select<2>("nearest", scene);
  const Stencils grown = select<2>("grow_until[cond_max=500]", scene);
  const std::vector<int> anchors = scene.sites.wanted_anchors();
  const auto before =
      scene.method->condition(scene.sites, anchors, base, Scaling::both, ConditionNorm::two);
  const auto after =
      scene.method->condition(scene.sites, anchors, grown, Scaling::both, ConditionNorm::two);
  int changed = 0;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    EXPECT_LE(after[i], 500);
    const auto at = static_cast<int>(i);
    EXPECT_EQ(grown[at].size() > base[at].size(), before[i] > 500) << "grown only where it must";
    changed += grown[at].size() > base[at].size() ? 1 : 0;
  }
  EXPECT_GT(changed, 3);
  EXPECT_LE(select<2>("grow_until[cond_max=1,cap=14]", scene)[0].size(), 16U);
}

TEST(ContractRules, ZonedTakesEachRuleInItsZone) {
  TestScene<2> scene = make_scene<2>("mfpm", "perturbed", 12, 1);
  const Stencils stencils =
      select<2>("zoned[interior=nearest[k=7,ties=cut],boundary=nearest[k=15,ties=cut]]", scene);
  for (int a = 0; a < stencils.size(); ++a) {
    EXPECT_EQ(stencils[a].size(), scene.cloud.is_boundary(a) ? 15U : 7U);
  }
}

}  // namespace
}  // namespace strongpoint
