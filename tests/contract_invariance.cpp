// What must not change the weights of any registered method, and means of them.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/spans.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Largest difference of two sets of weights, node by node, each derivative relative to its largest
/// weight. `renamed` is what node i of the first set is called in the second; the same when empty.
double difference(const Weights& a, const Weights& b, const std::vector<double>& factor,
                  const std::vector<int>& renamed = {}) {
  double worst = 0;
  std::vector<int> place;  // in a row of b: the order of equally far nodes is left to the method
  for (int p = 0; p < a.size(); ++p) {
    int next = 0;
    for (const int node : b.nodes(p)) {
      place.resize(std::max(place.size(), static_cast<std::size_t>(node) + 1));
      place[node] = next++;
    }
    for (int d = 0; d < a.per_entry; ++d) {
      const auto row = a.row(p).row(d);
      if (row.size() == 0) continue;
      const double scale = row.cwiseAbs().maxCoeff();
      for (Eigen::Index j = 0; j < row.size(); ++j) {
        const int node = a.nodes(p)[static_cast<std::size_t>(j)];
        const int other = place[renamed.empty() ? node : renamed[node]];
        worst = std::max(worst, std::abs(row[j] - factor[d] * b.row(p)(d, other)) / scale);
      }
    }
  }
  return worst;
}

template <int Dim>
void check_similarity(const std::string& spec, double scale, double shift) {
  TestScene<Dim> scene = make_scene<Dim>(spec, "perturbed", 8, 5);
  if (scale != 1 && !scene.method->promises().scale_covariant) return;
  const Derivatives<Dim> derivatives = supported_derivatives(*scene.method);
  const Weights before = scene.method->weights(scene.sites, scene.stencils, derivatives);
  for (Points<Dim>* points : {&scene.sites.nodes, &scene.sites.anchors, &scene.sites.points}) {
    *points = (*points * scale).array() + shift;
  }
  scene.sites.volumes *= std::pow(scale, Dim);
  scene.sites.spacing *= scale;
  const Weights after = scene.method->weights(scene.sites, scene.stencils, derivatives);
  std::vector<double> factor;
  for (const MultiIndex<Dim>& alpha : derivatives)
    factor.push_back(std::pow(scale, order_of<Dim>(alpha)));
  // Moving the nodes rounds their coordinates, 1e-15 of a stencil; weights of thin stencils amplify
  // it by conditions of up to 1e7.
  EXPECT_LT(difference(before, after, factor), 1e-7) << spec << " in " << Dim << "D";
}

TEST(ContractInvariance, AreInvariantUnderTranslationAndScaleLikeTheirOrder) {
  for (const std::string& spec : method_specs<1>(3)) {
    check_similarity<1>(spec, 1, 2.75);
    check_similarity<1>(spec, 1e-3, 0);
  }
  for (const std::string& spec : method_specs<2>(3)) {
    check_similarity<2>(spec, 1, -1.5);
    check_similarity<2>(spec, 512, 0);
  }
  for (const std::string& spec : method_specs<3>(3)) {
    check_similarity<3>(spec, 1, 0.625);
    check_similarity<3>(spec, 1e3, 0);
  }
}

TEST(ContractInvariance, AreInvariantUnderPermutationOfTheNodes) {
  for (const std::string& spec : method_specs(3)) {
    TestScene<2> scene = make_scene<2>(spec, "perturbed", 10, 3);
    if (scene.method->needs().block) continue;  // the ids tell where a node is
    const Derivatives<2> derivatives = supported_derivatives(*scene.method);
    const Weights before = scene.method->weights(scene.sites, scene.stencils, derivatives);
    const int last = scene.sites.node_count() - 1;  // node i becomes node last - i
    scene.sites.nodes = scene.sites.nodes.rowwise().reverse().eval();
    if (scene.sites.volumes.size() > 0) {
      scene.sites.volumes = scene.sites.volumes.reverse().eval();
    }
    for (int& node : scene.sites.anchor_node) node = last - node;
    for (int& node : scene.stencils.nodes) node = last - node;
    const Weights after = scene.method->weights(scene.sites, scene.stencils, derivatives);
    const std::vector<int>& renamed = scene.sites.anchor_node;  // of the node at each anchor
    EXPECT_LT(difference(before, after, std::vector<double>(derivatives.size(), 1), renamed), 1e-12)
        << spec;
  }
}

/// Weights of one derivative at one point, by node id. A method may leave out nodes whose weights
/// are zero for all derivatives asked for, so that rows differ in their nodes and not in what they
/// say.
std::map<int, double> weights_by_node(const Weights& weights, int point, int derivative) {
  std::map<int, double> result;
  for (std::size_t j = 0; j < weights.nodes(point).size(); ++j) {
    const double weight = weights.row(point)(derivative, static_cast<Eigen::Index>(j));
    if (weight != 0) result[weights.nodes(point)[j]] = weight;
  }
  return result;
}

TEST(ContractInvariance, GiveTheSameWeightsWhenFewerDerivativesAreAskedFor) {
  for (const std::string& spec : method_specs(4)) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 5);
    const Derivatives<2> all = supported_derivatives(*scene.method);
    const Weights full = scene.method->weights(scene.sites, scene.stencils, all);
    for (int d = 0; d < all.size(); ++d) {
      const Weights one = scene.method->weights(scene.sites, scene.stencils, {all[d]});
      for (int p = 0; p < full.size(); ++p) {
        EXPECT_EQ(weights_by_node(full, p, d), weights_by_node(one, p, 0))
            << spec << ' ' << name_of<2>(all[d]);
      }
    }
  }
}

TEST(ContractInvariance, GiveRowsWithoutWeightsWhenNoDerivativeIsAskedFor) {
  for (const std::string& spec : method_specs(2)) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 5);
    const Weights none = scene.method->weights(scene.sites, scene.stencils, {});
    EXPECT_EQ(none.size(), scene.sites.node_count()) << spec;
    EXPECT_TRUE(none.values.empty()) << spec;
  }
}

TEST(ContractInvariance, DoNotDependOnNodesOutsideTheStencil) {
  for (const std::string& spec : method_specs(2)) {
    TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 144);  // the corner (0, 0) only
    if (!scene.method->promises().local) continue;
    const Weights before = scene.method->weights(scene.sites, scene.stencils, {{1, 0}});
    scene.sites.nodes.col(scene.sites.node_count() - 1) *= 3;
    const Weights after = scene.method->weights(scene.sites, scene.stencils, {{1, 0}});
    EXPECT_EQ(before.values, after.values) << spec;
  }
}

TEST(ContractInvariance, GiveTheMeanOverASpanOfTheWeightsAtItsEnds) {
  for (const std::string& spec : method_specs(2)) {
    TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 5);
    Sites<2>& sites = scene.sites;
    const Derivatives<2> derivatives{{1, 0}, {0, 1}};
    std::vector<std::map<int, double>> expected(static_cast<std::size_t>(2 * sites.point_count()));
    const Points<2> anchors = sites.points;
    const Points<2> inwards = Point<2>(0.48, 0.52).replicate(1, anchors.cols()) - anchors;
    for (const double end : {0.02, 0.06}) {
      sites.points = anchors + end * inwards;
      const Weights weights = scene.method->weights(sites, scene.stencils, derivatives);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const auto point = static_cast<int>(i / 2);
        for (const auto& [node, weight] : weights_by_node(weights, point, i % 2)) {
          expected[i][node] += 0.5 * weight;
        }
      }
    }
    sites.points = anchors + 0.04 * inwards;
    sites.spans = 0.02 * inwards;
    const Weights means = weights_on<2>(*scene.method, sites, scene.stencils, derivatives);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto found = weights_by_node(means, static_cast<int>(i / 2), i % 2);
      double size = 0;
      for (const auto& [node, weight] : expected[i]) size = std::max(size, std::abs(weight));
      for (const auto& [node, weight] : found) expected[i][node] -= weight;
      for (const auto& [node, left] : expected[i]) {
        EXPECT_LE(std::abs(left), 1e-8 * size) << spec << " at node " << node;
      }
    }
  }
}

TEST(ContractInvariance, AreBitwiseEqualOnOneAndFourThreads) {
  for (const std::string& spec : method_specs(2)) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 25, 1);
    const Derivatives<2> derivatives = supported_derivatives(*scene.method);
    omp_set_num_threads(1);
    const Weights one = scene.method->weights(scene.sites, scene.stencils, derivatives);
    omp_set_num_threads(4);
    const Weights four = scene.method->weights(scene.sites, scene.stencils, derivatives);
    omp_set_num_threads(1);
    EXPECT_EQ(one.values, four.values) << spec;
  }
}

}  // namespace
}  // namespace strongpoint
