// The blend of maximum-entropy functions with B-splines at the ends of a line.
#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// At the end of the strip and across the splines' knots nothing jumps.
TEST(MaxEntropyBlend, IsContinuous) {
  const TestScene<1> scene = make_scene<1>("max_ent[order=2,boundary=bspline]", "grid", 31, 1);
  constexpr double tiny = 1e-7;
  for (double x : {1e-6, 2.0 / 30, 3.0 / 30, 4.0 / 30}) {
    Points<1> sides(1, 2);
    sides << x - tiny, x + tiny;
    const Weights w = weights_at<1>(scene, 3, sides, {{0}, {1}});
    EXPECT_LT((w.row(0) - w.row(1)).row(0).cwiseAbs().maxCoeff(), 1e-4) << x;  // slope 1/h = 30
    EXPECT_LT((w.row(0) - w.row(1)).row(1).cwiseAbs().maxCoeff(), 1e-2) << x;  // of 30
  }
}

TEST(MaxEntropyBlend, StartsWithTheNodeAtTheEnd) {
  const TestScene<1> scene = make_scene<1>("max_ent[boundary=bspline]", "grid", 31, 1);
  const Weights w = weights_at<1>(scene, 0, Points<1>::Constant(1, 1, 0.0), {{0}, {1}});
  for (std::size_t j = 0; j < w.nodes(0).size(); ++j) {
    const int node = w.nodes(0)[j];
    EXPECT_NEAR(w.row(0)(0, static_cast<Eigen::Index>(j)), node == 0 ? 1 : 0, 1e-14);
    EXPECT_NEAR(w.row(0)(1, static_cast<Eigen::Index>(j)),
                node == 0   ? -30
                : node == 1 ? 30
                            : 0,
                1e-10);
  }
}

TEST(MaxEntropyBlend, RefusesStencilsWithoutNodesBehindItsSplines) {
  const TestScene<1> scene = make_scene<1>("max_ent[boundary=bspline]", "grid", 31, 1);
  const auto search = make_search<1>("auto", scene.sites.nodes);
  const Stencils pairs = search->nearest(scene.sites.anchors, 2, Ties::cut);
  try {
    scene.method->weights(scene.sites, pairs, {{0}});
    ADD_FAILURE() << "two nodes carry the splines only";
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("at least 4"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace strongpoint
