// Fits with the value among their unknowns: a closed form, a limit, and places that are no nodes.
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Largest difference of two sets of weights, each derivative relative to its largest weight.
double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::ArrayXd scale = b.cwiseAbs().rowwise().maxCoeff();
  return ((a - b).cwiseAbs().rowwise().maxCoeff().array() / scale).maxCoeff();
}

TEST(ExtendedFit, HasTheKnownLaplacianOnABlockOfAGrid) {
  Points<2> nodes(2, 9);
  for (int i = 0; i < 9; ++i) {
    const int row = i / 3;
    nodes.col(i) << 0.25 * row, 0.25 * (i - 3 * row);
  }
  Sites<2> sites = sites_at_nodes<2>(nodes);
  std::vector<int> block(9);
  std::iota(block.begin(), block.end(), 0);
  Stencils stencils;
  for (int a = 0; a < 9; ++a) {
    stencils.push_back(a == 4 ? std::span<const int>(block) : std::span<const int>{});
  }
  const auto method = make_method<2>("mfpm_extended").made;
  const Weights weights = method->weights(sites, stencils, {{2, 0}, {0, 2}});
  const Eigen::VectorXd laplacian = weights.row(4).colwise().sum();
  Eigen::VectorXd expected(9);
  expected << 2, -1, 2, -1, -4, -1, 2, -1, 2;  // closed form, over 3 h^2
  EXPECT_LT((laplacian - expected / (3 * 0.25 * 0.25)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ExtendedFit, WithAWeightInfiniteAtTheCentreAlmostKnowsTheValue) {
  const TestScene<2> scene = make_scene<2>("gmls[weight=inverse_cube]", "perturbed", 10, 7);
  const Derivatives<2> derivatives = Derivatives<2>::between_orders(0, 2);
  const Weights unknown = scene.method->weights(scene.sites, scene.stencils, derivatives);
  const Weights known =
      make_method<2>("gfdm").made->weights(scene.sites, scene.stencils, derivatives);
  for (const int p : scene.sites.wanted_anchors()) {
    EXPECT_LT(difference(unknown.row(p), known.row(p)), 0.05) << "node " << p;
  }
}

TEST(ExtendedFit, AndMovingFitsNeedNoNodeAtTheAnchor) {
  for (const char* spec : {"mls", "rkpm", "gmls", "mfpm_extended", "gmls[weight=power[p=16]]"}) {
    TestScene<2> scene = make_scene<2>(spec, "perturbed", 10, 1);
    Sites<2>& sites = scene.sites;
    for (int a = 0; a < sites.anchor_count(); ++a) {
      sites.anchors.col(a) += 0.05 * (Point<2>(0.52, 0.49) - sites.anchors.col(a));
    }
    sites.points = sites.anchors;
    std::fill(sites.anchor_node.begin(), sites.anchor_node.end(), -1);
    const auto search = make_search<2>("auto", sites.nodes);
    const auto rule = make_rule<2>(scene.method->default_stencil()).made;
    scene.stencils = select_stencils<2>(*rule, sites, *scene.method, *search);
    const Derivatives<2> derivatives{{0, 0}, {1, 0}, {0, 2}};
    const Weights weights = scene.method->weights(sites, scene.stencils, derivatives);
    for (int p = 0; p < weights.size(); ++p) {
      Eigen::VectorXd values(weights.nodes(p).size());
      for (int j = 0; j < values.size(); ++j) {
        const Point<2> x = sites.nodes.col(weights.nodes(p)[j]);
        values[j] = 1 + x[0] - 2 * x[1] + x[0] * x[1] - 3 * x[1] * x[1];
      }
      const Point<2> x = sites.points.col(p);
      const Eigen::Vector3d exact(1 + x[0] - 2 * x[1] + x[0] * x[1] - 3 * x[1] * x[1], 1 + x[1],
                                  -6);
      EXPECT_LT((weights.row(p) * values - exact).cwiseAbs().maxCoeff(), 1e-9) << spec;
    }
  }
}

}  // namespace
}  // namespace strongpoint
