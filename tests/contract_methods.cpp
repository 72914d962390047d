// What every registered method declares of itself is checked here, and nothing else.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/monomial.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Round-off of a sum of weighted values, relative to the sum of their magnitudes. Orders up to 8
/// are solved with condition numbers up to about 1e6, which costs that factor.
double reproduction_tolerance(int degree) {
  return degree <= 2 ? 1e-11 : degree <= 4 ? 1e-10 : 1e-9;
}

/// Largest residual of the weights on a monomial centred at the point and scaled by the stencil
/// radius, relative to sum |w| |p|, over points and derivatives.
template <int Dim>
double worst_residual(const TestScene<Dim>& scene, const Weights& weights,
                      const Derivatives<Dim>& derivatives, const MultiIndex<Dim>& alpha) {
  double worst = 0;
  for (int p = 0; p < weights.size(); ++p) {
    const std::span<const int> nodes = weights.nodes(p);
    if (nodes.empty()) continue;
    const Point<Dim> centre = scene.sites.anchors.col(scene.sites.point_anchor[p]);
    const double radius = (scene.sites.nodes.col(nodes.back()) - centre).norm();
    const Point<Dim> at = (scene.sites.points.col(p) - centre) / radius;
    for (int d = 0; d < derivatives.size(); ++d) {
      const double scale = std::pow(radius, order_of<Dim>(derivatives[d]));
      double sum = 0;
      double magnitude = 0;
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        const Point<Dim> z = (scene.sites.nodes.col(nodes[j]) - centre) / radius;
        const double term =
            scale * weights.row(p)(d, static_cast<Eigen::Index>(j)) * monomial<Dim>(z, alpha);
        sum += term;
        magnitude += std::abs(term);
      }
      const double exact = monomial_derivative<Dim>(alpha, derivatives[d], at);
      worst = std::max(worst, std::abs(sum - exact) / std::max(magnitude, std::abs(exact) + 1e-3));
    }
  }
  return worst;
}

template <int Dim>
void check_reproduction(const std::string& spec, const std::string& cloud) {
  const int declared = make_method<Dim>(spec).made->promises().reproduces;
  const int level = test_level<Dim>(declared);
  const int stride = std::max(1, static_cast<int>(std::pow(level, Dim)) / (declared > 4 ? 15 : 40));
  const TestScene<Dim> scene = make_scene<Dim>(spec, cloud, level, stride);
  Derivatives<Dim> derivatives;  // all of low order, and of the others every seventh
  int number = 0;
  for (const MultiIndex<Dim>& alpha : supported_derivatives(*scene.method)) {
    if (order_of<Dim>(alpha) <= 2 || number++ % 7 == 0) derivatives.merge({alpha});
  }
  const Weights weights = scene.method->weights(scene.sites, scene.stencils, derivatives);
  for (const MultiIndex<Dim>& alpha : Derivatives<Dim>::between_orders(0, declared)) {
    EXPECT_LT(worst_residual<Dim>(scene, weights, derivatives, alpha),
              reproduction_tolerance(declared))
        << spec << " in " << Dim << "D on " << cloud << ", monomial " << name_of<Dim>(alpha);
  }
  double next = 0;
  for (const MultiIndex<Dim>& alpha :
       Derivatives<Dim>::between_orders(declared + 1, declared + 1)) {
    next = std::max(next, worst_residual<Dim>(scene, weights, derivatives, alpha));
  }
  EXPECT_GT(next, 1e-6) << spec << " reproduces more than the degree it declares";
}

template <int Dim>
void check_reproduction_on_all_clouds(const std::vector<std::string>& specs) {
  for (const std::string& spec : specs) {
    for (const char* cloud : {"grid", "perturbed[amount=0.2]", "perturbed[amount=0.4]"}) {
      check_reproduction<Dim>(spec, cloud);
    }
  }
}

TEST(ContractMethods, ReproducePolynomialsUpToTheDeclaredDegreeAndNoFurtherIn1D) {
  check_reproduction_on_all_clouds<1>(method_specs<1>(8));
}
TEST(ContractMethods, ReproducePolynomialsUpToTheDeclaredDegreeAndNoFurtherIn2D) {
  check_reproduction_on_all_clouds<2>(method_specs(8));
}
TEST(ContractMethods, ReproducePolynomialsUpToTheDeclaredDegreeAndNoFurtherIn3D) {
  check_reproduction_on_all_clouds<3>(method_specs<3>(4));
}
TEST(SlowContractMethods, ReproducePolynomialsOfHighDegreeIn3D) {
  std::vector<std::string> high;
  for (const std::string& spec : method_specs<3>(8)) {
    if (spec.ends_with("=6]") || spec.ends_with("=8]")) high.push_back(spec);
  }
  check_reproduction_on_all_clouds<3>(high);
}

/// Weights up to order 4 on a unit-sized stencil are exact to 1e-9 in absolute terms.
TEST(ContractMethods, AreExactTo1em9InAbsoluteTermsUpToOrder4) {
  for (const std::string& spec : method_specs(4)) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed[amount=0.2]", 12, 7);
    const int degree = std::min(4, scene.method->promises().reproduces);
    const Derivatives<2> first{{1, 0}, {0, 1}};
    const Weights weights = scene.method->weights(scene.sites, scene.stencils, first);
    for (const MultiIndex<2>& alpha : Derivatives<2>::between_orders(0, degree)) {
      for (int p = 0; p < weights.size(); ++p) {
        const std::span<const int> nodes = weights.nodes(p);
        for (int d = 0; d < 2 && !nodes.empty(); ++d) {
          double sum = -monomial_derivative<2>(alpha, first[d], scene.sites.points.col(p));
          for (std::size_t j = 0; j < nodes.size(); ++j) {
            sum += weights.row(p)(d, static_cast<Eigen::Index>(j)) *
                   monomial<2>(scene.sites.nodes.col(nodes[j]), alpha);
          }
          EXPECT_LT(std::abs(sum), 1e-9) << spec << " at node " << p;
        }
      }
    }
  }
}

TEST(ContractMethods, DerivativeWeightsSumToZeroAndValueWeightsToOne) {
  for (const std::string& spec : method_specs(3)) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 11, 3);
    const Derivatives<2> derivatives = supported_derivatives(*scene.method);
    if (scene.method->promises().reproduces < 0) continue;
    const Weights weights = scene.method->weights(scene.sites, scene.stencils, derivatives);
    for (int p = 0; p < weights.size(); ++p) {
      if (weights.nodes(p).empty()) continue;
      const Eigen::VectorXd sums = weights.row(p).rowwise().sum();
      const Eigen::VectorXd sizes = weights.row(p).cwiseAbs().rowwise().sum();
      for (int d = 0; d < derivatives.size(); ++d) {
        const double expected = order_of<2>(derivatives[d]) == 0 ? 1 : 0;
        EXPECT_LT(std::abs(sums[d] - expected), 1e-11 * (sizes[d] + 1)) << spec;
      }
    }
  }
}

TEST(ContractMethods, GiveTheNodalParameterAsTheValueIfAndOnlyIfTheyInterpolate) {
  const Derivatives<2> value{{0, 0}};
  for (const std::string& spec : method_specs(4)) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 5);
    if (!scene.method->unsupported(value).empty()) continue;
    const Weights weights = scene.method->weights(scene.sites, scene.stencils, value);
    double worst = 0;
    for (int p = 0; p < weights.size(); ++p) {
      const std::span<const int> nodes = weights.nodes(p);
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        const double expected = nodes[j] == p ? 1 : 0;
        worst =
            std::max(worst, std::abs(weights.row(p)(0, static_cast<Eigen::Index>(j)) - expected));
      }
    }
    if (scene.method->promises().interpolates) {
      EXPECT_LT(worst, 1e-7) << spec;  // shape parameters of the default size cost half the digits
    } else {
      EXPECT_GT(worst, 1e-3) << spec << " interpolates and does not say so";
    }
  }
}

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

TEST(ContractMethods, AreInvariantUnderTranslationAndScaleLikeTheirOrder) {
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

TEST(ContractMethods, AreInvariantUnderPermutationOfTheNodes) {
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

TEST(ContractMethods, GiveTheSameWeightsWhenFewerDerivativesAreAskedFor) {
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

TEST(ContractMethods, GiveRowsWithoutWeightsWhenNoDerivativeIsAskedFor) {
  for (const std::string& spec : method_specs(2)) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 5);
    const Weights none = scene.method->weights(scene.sites, scene.stencils, {});
    EXPECT_EQ(none.size(), scene.sites.node_count()) << spec;
    EXPECT_TRUE(none.values.empty()) << spec;
  }
}

TEST(ContractMethods, DoNotDependOnNodesOutsideTheStencil) {
  for (const std::string& spec : method_specs(2)) {
    TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 144);  // the corner (0, 0) only
    if (!scene.method->promises().local) continue;
    const Weights before = scene.method->weights(scene.sites, scene.stencils, {{1, 0}});
    scene.sites.nodes.col(scene.sites.node_count() - 1) *= 3;
    const Weights after = scene.method->weights(scene.sites, scene.stencils, {{1, 0}});
    EXPECT_EQ(before.values, after.values) << spec;
  }
}

TEST(ContractMethods, EvaluateOffTheAnchorAsTheirLocalPolynomial) {
  for (const std::string& spec : method_specs(4)) {
    TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 9);
    Points<2> points(2, 2 * scene.sites.anchor_count());
    scene.sites.point_anchor.clear();
    for (int a = 0; a < scene.sites.anchor_count(); ++a) {
      const Point<2> anchor = scene.sites.anchors.col(a);  // never out of the nodes' convex hull
      points.col(2 * a) = anchor + 0.05 * (Point<2>(0.52, 0.49) - anchor);
      points.col(2 * a + 1) = anchor + 0.08 * (Point<2>(0.47, 0.51) - anchor);
      scene.sites.point_anchor.insert(scene.sites.point_anchor.end(), {a, a});
    }
    scene.sites.points = points;
    const Derivatives<2> derivatives{{0, 0}, {1, 0}, {0, 1}};
    const Weights weights = scene.method->weights(scene.sites, scene.stencils, derivatives);
    const int degree = scene.method->promises().reproduces;
    for (const MultiIndex<2>& alpha : Derivatives<2>::between_orders(0, degree)) {
      EXPECT_LT(worst_residual<2>(scene, weights, derivatives, alpha), 1e-11) << spec;
    }
  }
}

TEST(ContractMethods, ReproducePolynomialsAtAnchorsThatAreNoNodesUnlessTheyNeedACentre) {
  for (const std::string& spec : method_specs(4)) {
    TestScene<2> scene = make_scene<2>(spec, "perturbed", 12, 9);
    const Needs needs = scene.method->needs();
    if (needs.centre || needs.block) continue;
    for (int a = 0; a < scene.sites.anchor_count(); ++a) {  // stencils stay, they serve nearby too
      scene.sites.anchors.col(a) += 0.05 * (Point<2>(0.52, 0.49) - scene.sites.anchors.col(a));
      scene.sites.anchor_node[a] = -1;
    }
    scene.sites.points = scene.sites.anchors;
    const Derivatives<2> derivatives{{0, 0}, {1, 0}, {0, 1}};
    const Weights weights = scene.method->weights(scene.sites, scene.stencils, derivatives);
    const int degree = scene.method->promises().reproduces;
    for (const MultiIndex<2>& alpha : Derivatives<2>::between_orders(0, degree)) {
      EXPECT_LT(worst_residual<2>(scene, weights, derivatives, alpha), 1e-11) << spec;
    }
  }
}

TEST(ContractMethods, AreBitwiseEqualOnOneAndFourThreads) {
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
