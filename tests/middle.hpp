#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "tests/contract_support.hpp"

namespace strongpoint {

/// The stencil, the weights and the condition of a method at the node in the middle of a cloud.
struct Middle {
  Points<2> nodes;          ///< (2, n) relative to the centre
  double spacing = 0;       ///< the local one, 0 when the method does not need it
  Eigen::MatrixXd weights;  ///< (derivatives, n)
  double condition = 0;
};

/// Weights of one node of a perturbed cloud of the unit square, by a stencil rule unless the method
/// uses every node.
inline Middle weights_in_the_middle(const std::string& method, const std::string& stencil,
                                    int level, const Derivatives<2>& derivatives) {
  TestScene<2> scene = make_scene<2>(method, "perturbed[amount=0.2]", level, 1);
  const int centre = level / 2 * level + level / 2;
  std::fill(scene.sites.wanted.begin(), scene.sites.wanted.end(), 0);
  scene.sites.wanted[centre] = 1;
  const auto search = make_search<2>("auto", scene.sites.nodes);
  if (scene.method->promises().local) {
    const auto rule = make_rule<2>(stencil).made;
    scene.stencils = select_stencils<2>(*rule, scene.sites, *scene.method, *search);
  }
  const Weights weights = scene.method->weights(scene.sites, scene.stencils, derivatives);
  Middle middle;
  const std::span<const int> nodes = weights.nodes(centre);
  middle.nodes.resize(2, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    middle.nodes.col(static_cast<Eigen::Index>(j)) =
        scene.sites.nodes.col(nodes[j]) - scene.sites.nodes.col(centre);
  }
  middle.spacing = scene.sites.spacing.size() > 0 ? scene.sites.spacing[centre] : 0;
  middle.weights = weights.row(centre);
  Stencils alone;
  if (scene.method->promises().local) alone.push_back(scene.stencils[centre]);
  const std::vector<int> anchors{centre};
  middle.condition =
      scene.method->condition(scene.sites, anchors, alone, Scaling::both, ConditionNorm::two)[0];
  return middle;
}

/// Largest difference, each derivative relative to its largest weight.
inline double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  double worst = 0;
  for (Eigen::Index d = 0; d < a.rows(); ++d) {
    worst = std::max(worst,
                     (a.row(d) - b.row(d)).cwiseAbs().maxCoeff() / b.row(d).cwiseAbs().maxCoeff());
  }
  return worst;
}

/// Round-off of 15 digits times conditions of up to 1e7, of either solve.
inline constexpr double solved = 1e-8;

/// Error of the second derivative of sin(2 x + 1) cos(3 y) about the middle, relative to its size.
inline double second_derivative_error(const Middle& middle) {
  double computed = 0;
  for (Eigen::Index j = 0; j < middle.nodes.cols(); ++j) {
    computed += middle.weights(0, j) * std::sin(2 * middle.nodes(0, j) + 1) *
                std::cos(3 * middle.nodes(1, j));
  }
  return std::abs(computed / (-4 * std::sin(1.0)) - 1);
}

}  // namespace strongpoint
