// Interpolation by delta basis functions, against jets and dense linear algebra.
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "problems/core/jet.hpp"
#include "tests/middle.hpp"

namespace strongpoint {
namespace {

/// One coordinate of (1.37), of numbers and jets.
template <class T>
T delta_factor(const T& t, double s) {
  using std::sin;
  constexpr int sines = 8;  // the defaults of delta
  T sum = 0;
  for (int n = 1; n <= sines; ++n) {
    const double ratio = n / (sines + 1.0);
    const double half = n * std::numbers::pi / 2;
    sum += std::pow(1 - ratio * ratio, 8) * std::sin(half * (s + 1)) * sin(half * (t + 1));
  }
  return sum;
}

TEST(Delta, WeightsEqualThoseOfADenseSolve) {
  const Derivatives<2> derivatives{{0, 0}, {1, 0}, {2, 0}, {1, 1}, {0, 3}};
  const Middle middle = weights_in_the_middle("delta", "nearest[k=20]", 9, derivatives);
  const Point<2> low = middle.nodes.rowwise().minCoeff();
  const Point<2> size = middle.nodes.rowwise().maxCoeff() - low;
  const auto mapped = [&](const auto& x, int c) { return (x - low[c]) / size[c] - 0.5; };
  const Eigen::Index n = middle.nodes.cols();
  Eigen::MatrixXd matrix(n, n);
  Eigen::MatrixXd right(n, derivatives.size());
  using J = Jet<2, 3>;
  for (Eigen::Index j = 0; j < n; ++j) {
    const Point<2> node(mapped(middle.nodes(0, j), 0), mapped(middle.nodes(1, j), 1));
    for (Eigen::Index i = 0; i < n; ++i) {
      matrix(i, j) = delta_factor(mapped(middle.nodes(0, i), 0), node[0]) *
                     delta_factor(mapped(middle.nodes(1, i), 1), node[1]);
    }
    const J jet = delta_factor(mapped(J::variable(0, 0), 0), node[0]) *
                  delta_factor(mapped(J::variable(0, 1), 1), node[1]);
    for (int d = 0; d < derivatives.size(); ++d) right(j, d) = jet.derivative(derivatives[d]);
  }
  const Eigen::MatrixXd expected = matrix.fullPivLu().solve(right).transpose();
  EXPECT_LT(difference(middle.weights, expected), solved);
}

TEST(Delta, TellsApartAsManyNodesOnALineAsItHasSines) {
  const auto weights = [](const std::string& spec) {
    const TestScene<1> scene = make_scene<1>(spec, "perturbed", 11, 1);
    return scene.method->weights(scene.sites, scene.stencils, {{1}});
  };
  EXPECT_NO_THROW(weights("delta[M=5]"));
  try {
    weights("delta[M=4]");
    ADD_FAILURE() << "the matrix of five nodes has rank four";
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("larger M"), std::string::npos) << error.what();
  }
}

TEST(Delta, ErrsInTheSecondDerivativeTheMoreTheFinerTheNodes) {
  const auto at = [](int level) {
    return second_derivative_error(weights_in_the_middle("delta", "nearest", level, {{2, 0}}));
  };
  EXPECT_GT(at(81), 10 * at(11));
}

}  // namespace
}  // namespace strongpoint
