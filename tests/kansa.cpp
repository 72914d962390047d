// Interpolation by radial basis functions on all nodes at once.
#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "tests/middle.hpp"

namespace strongpoint {
namespace {

TEST(Kansa, OnTwentyFiveNodesIsRbfOnAllOfThem) {
  const Derivatives<2> derivatives = Derivatives<2>::between_orders(1, 2);
  for (const std::string options : {"kernel=mq", "kernel=imq", "kernel=gauss"}) {
    const std::string shape = "[" + options + ",shape_length=0.4]";
    const TestScene<2> local = make_scene<2>("rbf" + shape, "perturbed", 5, 1);
    const TestScene<2> global = make_scene<2>("kansa" + shape, "perturbed", 5, 1);
    const auto search = make_search<2>("auto", local.sites.nodes);
    const Stencils all = search->nearest(local.sites.anchors, 25, Ties::keep);
    const Weights a = local.method->weights(local.sites, all, derivatives);
    const Weights b = global.method->weights(global.sites, {}, derivatives);
    EXPECT_EQ(a.columns, b.columns) << "rows are sorted by distance";
    for (int p = 0; p < a.size(); ++p) EXPECT_LT(difference(b.row(p), a.row(p)), 1e-7) << options;
  }
}

TEST(Kansa, SaysWhyItGivesUp) {
  const auto message_of = [](const std::string& spec, int level) -> std::string {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", level, 50);
    try {
      scene.method->weights(scene.sites, scene.stencils, {{2, 0}});
    } catch (const CaseError& error) {
      return error.what();
    } catch (const SkipCase& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message_of("kansa[shape_length=0.1]", 11), "no error");
  EXPECT_NE(message_of("kansa[shape_length=30]", 11).find("smaller shape"), std::string::npos);
  EXPECT_NE(message_of("kansa[shape_length=0.1]", 55).find("at most 3000 nodes"),
            std::string::npos);
  const TestScene<2> scene = make_scene<2>("kansa", "grid", 7, 1);
  const std::vector<int> anchors{0, 24, 48};
  const std::vector<double> condition =
      scene.method->condition(scene.sites, anchors, {}, Scaling::both, ConditionNorm::two);
  ASSERT_EQ(condition.size(), 3U);
  EXPECT_EQ(condition[0], condition[2]);
  const double one =
      scene.method->condition(scene.sites, anchors, {}, Scaling::both, ConditionNorm::one)[0];
  EXPECT_LT(condition[0], 49 * one);  // the two norms differ by at most the size
  EXPECT_LT(one, 49 * condition[0]);
}

TEST(Kansa, GainsDigitsWhileItsConditionRises) {
  const auto at = [](const std::string& spec) {
    return weights_in_the_middle(spec, "nearest", 15, {{2, 0}});
  };
  const Middle sharp = at("kansa[shape=2]");
  const Middle flat = at("kansa[shape=8]");
  EXPECT_LT(second_derivative_error(flat), 0.05 * second_derivative_error(sharp));
  EXPECT_GT(flat.condition, 1e6 * sharp.condition);
}

}  // namespace
}  // namespace strongpoint
