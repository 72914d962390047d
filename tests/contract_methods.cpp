// What every registered method declares of itself is checked here, and nothing else: what its
// weights reproduce.
#include <algorithm>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace strongpoint
