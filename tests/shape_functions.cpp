// Fits whose value is unknown: shape functions and their derivatives against independent formulas,
// and where one method has to be another.
#include <cmath>
#include <numeric>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "methods/core/monomial.hpp"
#include "methods/core/moving_fit.hpp"
#include "methods/core/polynomial_fit.hpp"
#include "methods/core/taylor_fit.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Sums of weighted values lose this much to round-off at the low degrees used here.
constexpr double round_off = 1e-11;

/// The kernel of a local method.
template <class Kernel, int Dim>
const Kernel& kernel_of(const Method<Dim>& method) {
  return dynamic_cast<const LocalMethod<Dim, Kernel>&>(method).kernel();
}

/// Weights (derivatives, n) of a kernel on a stencil in scaled coordinates.
template <int Dim, class Kernel>
Eigen::MatrixXd weights_at(const Kernel& kernel, const LocalStencil<Dim>& stencil,
                           const Point<Dim>& offset, const Derivatives<Dim>& derivatives) {
  typename Kernel::Workspace work;
  EXPECT_EQ(kernel.factorise(stencil, work), LocalOutcome::ok);
  Eigen::MatrixXd result(derivatives.size(), stencil.size);
  kernel.evaluate(stencil, work, offset, derivatives, {result.data(), result.rows(), stencil.size});
  return result;
}

/// The stencil of an anchor of a scene.
template <int Dim>
LocalStencil<Dim> stencil_of(const TestScene<Dim>& scene, int anchor) {
  LocalStencil<Dim> stencil;
  EXPECT_EQ(stencil.gather(scene.sites, scene.stencils[anchor], anchor), LocalOutcome::ok);
  return stencil;
}

/// Largest difference of two sets of weights, each derivative relative to its largest weight.
double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::ArrayXd scale = b.cwiseAbs().rowwise().maxCoeff();
  return ((a - b).cwiseAbs().rowwise().maxCoeff().array() / scale).maxCoeff();
}

/// Values of the shape functions at x as the textbook has them, W P A^-1 p(x), with a Gauss bell.
template <int Dim>
Eigen::VectorXd dense_shape_functions(const LocalStencil<Dim>& stencil, const Point<Dim>& x,
                                      int degree, double length) {
  const Derivatives<Dim> monomials = Derivatives<Dim>::between_orders(0, degree);
  Eigen::MatrixXd basis(monomials.size(), stencil.size);
  Eigen::VectorXd window(stencil.size);
  Eigen::VectorXd at_x(monomials.size());
  for (int a = 0; a < monomials.size(); ++a) {
    at_x[a] = monomial<Dim>(x, monomials[a]);
    for (int j = 0; j < stencil.size; ++j)
      basis(a, j) = monomial<Dim>(stencil.node(j), monomials[a]);
  }
  for (int j = 0; j < stencil.size; ++j) {
    window[j] = std::exp(-(x - stencil.node(j)).squaredNorm() / (length * length));
  }
  const Eigen::MatrixXd moments = basis * window.asDiagonal() * basis.transpose();
  return window.asDiagonal() * basis.transpose() * moments.fullPivLu().solve(at_x);
}

/// Derivatives of a vector-valued function by differences of fourth order, step by step.
template <int Dim, class Function>
Eigen::VectorXd difference_quotient(const Function& f, const Point<Dim>& x, MultiIndex<Dim> alpha,
                                    double step) {
  int axis = 0;
  while (axis < Dim && alpha[axis] == 0) ++axis;
  if (axis == Dim) return f(x);
  --alpha[axis];
  const auto at = [&](double shift) {
    Point<Dim> moved = x;
    moved[axis] += shift * step;
    return difference_quotient<Dim>(f, moved, alpha, step);
  };
  return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step);
}

template <int Dim>
void check_against_dense_formula(int degree) {
  const std::string spec = "mls[degree=" + std::to_string(degree) + ",kernel=gauss]";
  const TestScene<Dim> scene = make_scene<Dim>(spec, "perturbed", 9, 7);
  const MovingFit<Dim>& fit = kernel_of<MovingFit<Dim>>(*scene.method);
  const Derivatives<Dim> derivatives = Derivatives<Dim>::between_orders(0, 3);
  for (const int anchor : scene.sites.wanted_anchors()) {
    const LocalStencil<Dim> stencil = stencil_of(scene, anchor);
    const double length = fit.kernel().length(stencil);
    const Eigen::MatrixXd weights = weights_at<Dim>(fit, stencil, Point<Dim>::Zero(), derivatives);
    Eigen::MatrixXd expected(derivatives.size(), stencil.size);
    for (int d = 0; d < derivatives.size(); ++d) {
      expected.row(d) = difference_quotient<Dim>(
          [&](const Point<Dim>& x) {
            return dense_shape_functions<Dim>(stencil, x, degree, length);
          },
          Point<Dim>::Zero(), derivatives[d], 0.003 * length);
    }
    EXPECT_LT(difference(weights.topRows(1), expected.topRows(1)), 1e-10) << spec;
    // Third differences lose 1e-16 / 0.003^3 to round-off and take 0.003^4 / 10 in truncation, both
    // times what derivatives of higher order than the third are larger, up to 10^4.
    EXPECT_LT(difference(weights, expected), 2e-6) << spec << " in " << Dim << "D";
  }
}

TEST(ShapeFunctions, AndTheirDerivativesAreThoseOfTheTextbookFormula) {
  for (const int degree : {0, 1, 2, 3}) check_against_dense_formula<1>(degree);
  for (const int degree : {0, 1, 2, 3}) check_against_dense_formula<2>(degree);
  for (const int degree : {1, 2}) check_against_dense_formula<3>(degree);
}

template <int Dim>
void check_against_differences(const std::string& spec) {
  const TestScene<Dim> scene = make_scene<Dim>(spec, "perturbed", 8, 11);
  const MovingFit<Dim>& fit = kernel_of<MovingFit<Dim>>(*scene.method);
  // The splines' third derivatives jump at the nodes and at the edge of the support, which costs
  // differences of this step about step^2 times the largest of them.
  constexpr double step = 1e-4;
  const Derivatives<Dim> derivatives = Derivatives<Dim>::between_orders(1, 2);
  for (const int anchor : scene.sites.wanted_anchors()) {
    const LocalStencil<Dim> stencil = stencil_of(scene, anchor);
    const Point<Dim> offset = 0.1 * (Point<Dim>::Constant(0.47) - scene.sites.anchors.col(anchor));
    const Eigen::MatrixXd weights = weights_at<Dim>(fit, stencil, offset, derivatives);
    for (int d = 0; d < derivatives.size(); ++d) {
      MultiIndex<Dim> lower = derivatives[d];
      int axis = 0;
      while (lower[axis] == 0) ++axis;
      --lower[axis];
      const Point<Dim> shift = step * Point<Dim>::Unit(axis);
      const Eigen::MatrixXd quotient = (weights_at<Dim>(fit, stencil, offset + shift, {lower}) -
                                        weights_at<Dim>(fit, stencil, offset - shift, {lower})) /
                                       (2 * step);
      EXPECT_LT(difference(weights.row(d), quotient), 1e-4)
          << spec << " " << name_of<Dim>(derivatives[d]) << " at node " << anchor;
    }
  }
}

TEST(ShapeFunctions, HaveTheDerivativesThatDifferencesOfThemTendTo) {
  for (const char* spec : {"mls", "mls[degree=0]", "mls[degree=4]", "mls[kernel=wendland]",
                           "mls[degree=3,kernel=cubic_spline]", "rkpm", "rkpm[order=1]"}) {
    check_against_differences<1>(spec);
    check_against_differences<2>(spec);
  }
  check_against_differences<3>("mls");
  check_against_differences<3>("rkpm");
}

TEST(ShapeFunctions, ArePartitionsOfUnityNearTheAnchorToo) {
  for (const char* spec : {"mls[degree=0]", "mls", "rkpm", "mls[degree=5]"}) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 10, 7);
    const MovingFit<2>& fit = kernel_of<MovingFit<2>>(*scene.method);
    for (const int anchor : scene.sites.wanted_anchors()) {
      const Point<2> offset = 0.15 * (Point<2>(0.45, 0.51) - scene.sites.anchors.col(anchor));
      const Eigen::VectorXd sums =
          weights_at<2>(fit, stencil_of(scene, anchor), offset, {{0, 0}, {1, 0}, {0, 1}})
              .rowwise()
              .sum();
      EXPECT_LT((sums - Eigen::Vector3d(1, 0, 0)).cwiseAbs().maxCoeff(), 1e-10) << spec;
    }
  }
}

TEST(ShapeFunctions, WithAFixedWindowAreTheGeneralisedMovingLeastSquares) {
  for (const int degree : {1, 2, 4, 8}) {
    const std::string spec = "mls[derivatives=diffuse,degree=" + std::to_string(degree) + "]";
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 8 + degree, 17);
    const MovingFit<2>& fit = kernel_of<MovingFit<2>>(*scene.method);
    const auto full = make_method<2>("mls[degree=" + std::to_string(degree) + "]").made;
    const Derivatives<2> derivatives = Derivatives<2>::between_orders(0, std::min(degree, 4));
    for (const int anchor : scene.sites.wanted_anchors()) {
      const LocalStencil<2> stencil = stencil_of(scene, anchor);
      const double support = 2 * fit.kernel().length(stencil);
      const auto window = weight_of_distance([support](double rho) {
        const double t = rho / support;
        return std::pow(1 - t, 3) * (1 + 3 * t);
      });
      const Eigen::MatrixXd expected =
          weights_at<2>(PolynomialFit<2>(degree, window), stencil, Point<2>::Zero(), derivatives);
      // Nodes at the edge of the support make degree 8 lose seven digits.
      const double tolerance = degree < 8 ? round_off : 1e-9;
      EXPECT_LT(difference(weights_at<2>(fit, stencil, Point<2>::Zero(), derivatives), expected),
                tolerance)
          << spec;
      EXPECT_LT(difference(weights_at<2>(kernel_of<MovingFit<2>>(*full), stencil, Point<2>::Zero(),
                                         {{0, 0}}),
                           expected.topRows(1)),
                tolerance)
          << "the value does not depend on how the window is differentiated";
    }
  }
}

/// Six nodes, no more than degree 2 has terms.
LocalStencil<2> unisolvent_stencil() {
  Sites<2> sites;
  sites.nodes.resize(2, 6);
  sites.nodes << 0.5, 0.62, 0.41, 0.53, 0.44, 0.64, 0.5, 0.52, 0.47, 0.63, 0.38, 0.61;
  sites = sites_at_nodes<2>(sites.nodes);
  sites.spacing = Eigen::VectorXd::Constant(6, 0.1);
  LocalStencil<2> stencil;
  EXPECT_EQ(stencil.gather(sites, std::vector<int>{0, 1, 2, 3, 4, 5}, 0), LocalOutcome::ok);
  return stencil;
}

TEST(ShapeFunctions, OfAsManyNodesAsTermsInterpolateWhateverTheWindow) {
  const LocalStencil<2> stencil = unisolvent_stencil();
  const Derivatives<2> derivatives = Derivatives<2>::between_orders(0, 2);
  const Eigen::MatrixXd taylor = weights_at<2>(TaylorFit<2>(2, make_weight("one").made), stencil,
                                               Point<2>::Zero(), derivatives);
  for (const char* spec : {"mls", "mls[derivatives=diffuse]", "mls[kernel=gauss,h=1]"}) {
    const auto method = make_method<2>(spec).made;
    EXPECT_LT(difference(weights_at<2>(kernel_of<MovingFit<2>>(*method), stencil, Point<2>::Zero(),
                                       derivatives),
                         taylor),
              1e-9)  // condition of the interpolation: about 1e3
        << spec;
  }
  for (const char* weight : {"one", "bump4", "inverse_cube"}) {
    const PolynomialFit<2> fit(2, make_weight(weight).made);
    EXPECT_LT(difference(weights_at<2>(fit, stencil, Point<2>::Zero(), derivatives), taylor), 1e-9);
  }
}

TEST(ShapeFunctions, OfAFlatWindowHaveDiffuseDerivatives) {
  const TestScene<2> scene = make_scene<2>("gmls", "perturbed", 9, 7);
  const Derivatives<2> derivatives = Derivatives<2>::between_orders(1, 2);
  const auto deviation = [&](int anchor, int length) {
    LocalStencil<2> stencil = stencil_of(scene, anchor);
    stencil.spacing = 1.0 / 3;
    const std::string options = "[kernel=gauss,h=" + std::to_string(length);
    const auto full = make_method<2>("mls" + options + "]").made;
    const auto diffuse = make_method<2>("mls" + options + ",derivatives=diffuse]").made;
    return difference(
        weights_at<2>(kernel_of<MovingFit<2>>(*full), stencil, Point<2>::Zero(), derivatives),
        weights_at<2>(kernel_of<MovingFit<2>>(*diffuse), stencil, Point<2>::Zero(), derivatives));
  };
  for (const int anchor : scene.sites.wanted_anchors()) {
    const double wide = deviation(anchor, 10);
    const double flat = deviation(anchor, 20);
    EXPECT_LT(flat, 0.2) << "node " << anchor;
    EXPECT_NEAR(wide / flat, 4, 0.5) << "a Gauss bell is flat but for terms of order h^-2";
  }
}

TEST(ShapeFunctions, OfRkpmOnEqualVolumesAreThoseOfMls) {
  TestScene<2> scene = make_scene<2>("rkpm", "perturbed", 10, 1);
  scene.sites.volumes.setConstant(0.01);
  const Derivatives<2> derivatives = Derivatives<2>::between_orders(0, 2);
  const Weights rkpm = scene.method->weights(scene.sites, scene.stencils, derivatives);
  const Weights mls = make_method<2>("mls").made->weights(scene.sites, scene.stencils, derivatives);
  for (int p = 0; p < rkpm.size(); ++p) {
    EXPECT_LT(difference(rkpm.row(p), mls.row(p)), round_off) << "node " << p;
  }
}

TEST(ShapeFunctions, WhereTheWindowSeesTooFewNodesAreSingular) {
  const TestScene<2> scene = make_scene<2>("mls", "perturbed", 10, 7);
  const MovingFit<2>& fit = kernel_of<MovingFit<2>>(*scene.method);
  const LocalStencil<2> stencil = stencil_of(scene, 0);
  MovingFit<2>::Workspace work;
  ASSERT_EQ(fit.factorise(stencil, work), LocalOutcome::ok);
  Eigen::MatrixXd row(1, stencil.size);
  for (int repeat = 0; repeat < 2; ++repeat) {
    EXPECT_EQ(
        fit.evaluate(stencil, work, Point<2>(-1.5, 0), {{0, 0}}, {row.data(), 1, stencil.size}),
        LocalOutcome::singular);
  }
}

/// The default rule's factor is rounded to six digits, so that it may reach beyond the support.
TEST(ShapeFunctions, KeepTheirLengthOnStencilsOfTheirOwnRule) {
  const auto method = make_method<2>("mls[h=1.000003]").made;
  ASSERT_EQ(method->default_stencil(), "radius[factor=2.00001]");
  LocalStencil<2> stencil = unisolvent_stencil();
  stencil.spacing = 1 / 2.000009;  // the farthest node is within the rule's radius
  EXPECT_DOUBLE_EQ(kernel_of<MovingFit<2>>(*method).kernel().length(stencil),
                   1.000003 * stencil.spacing);
}

TEST(ShapeFunctions, OfUnequalVolumesDiffer) {
  const TestScene<2> scene = make_scene<2>("rkpm", "perturbed", 10, 7);
  const Weights rkpm = scene.method->weights(scene.sites, scene.stencils, {{1, 0}});
  const Weights mls = make_method<2>("mls").made->weights(scene.sites, scene.stencils, {{1, 0}});
  EXPECT_GT(difference(rkpm.row(0), mls.row(0)), 1e-2);
}

}  // namespace
}  // namespace strongpoint
