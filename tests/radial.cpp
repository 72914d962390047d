// Interpolation by radial basis functions on stencils, against jets and dense linear algebra.
#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "methods/core/radial_derivative.hpp"
#include "methods/core/radial_function.hpp"
#include "problems/core/jet.hpp"
#include "tests/middle.hpp"

namespace strongpoint {
namespace {

RadialFunction radial_function(const std::string& kernel, const std::string& power = "4") {
  const EntryInfo info{"test", "", RadialFunction::options("mq")};
  return RadialFunction(Options(info, {"test", {{"kernel", kernel}, {"power", power}}}));
}

/// The functions written once more, of s = r^2, for numbers and jets.
template <class T>
T phi(const std::string& kernel, const T& s, double c) {
  using std::exp, std::log, std::sqrt;
  if (kernel == "gauss") return exp(-s / (c * c));
  if (kernel == "mq") return sqrt(s + c * c);
  if (kernel == "imq") return 1 / sqrt(s + c * c);
  return s * s * log(s) / 2;  // tps, r^4 log r
}

constexpr std::array<const char*, 4> kernels{"gauss", "mq", "imq", "tps"};

TEST(RadialFunction, DerivativesByTheSquareOfTheDistanceEqualThoseOfJets) {
  constexpr int order = 6;
  for (const char* kernel : kernels) {
    for (const double s : {0.01, 0.3, 1.0, 4.0}) {
      const double c = 0.7;
      std::array<double, order + 1> f{};
      radial_function(kernel).evaluate(s, c, order, f.data());
      const auto jet = phi(kernel, Jet<1, order>::variable(s, 0), c);
      for (int m = 0; m <= order; ++m) {
        const double exact = jet.derivative({m});
        EXPECT_NEAR(f.at(m), exact, 1e-12 * (1 + std::abs(exact)))
            << kernel << ' ' << s << ' ' << m;
      }
    }
  }
}

TEST(RadialFunction, DerivativesInSpaceEqualThoseOfJets) {
  constexpr int order = 4;
  const Point<3> x(0.4, -0.2, 0.5);
  Jet<3, order> s;
  for (int c = 0; c < 3; ++c) {
    const auto coordinate = Jet<3, order>::variable(x[c], c);
    s += coordinate * coordinate;
  }
  for (const char* kernel : kernels) {
    const auto jet = phi(kernel, s, 0.9);
    std::array<double, order + 1> f{};
    radial_function(kernel).evaluate(x.squaredNorm(), 0.9, order, f.data());
    for (const MultiIndex<3>& alpha : Derivatives<3>::between_orders(0, order)) {
      EXPECT_NEAR(RadialDerivative<3>(alpha)(x, f.data()), jet.derivative(alpha), 1e-12)
          << kernel << ' ' << name_of<3>(alpha);
    }
  }
}

TEST(RadialFunction, DerivativesAtTheNodeAreThoseOfTheSeries) {
  const auto at_node = [](const std::string& kernel, const MultiIndex<2>& alpha) {
    std::array<double, 5> f{};
    radial_function(kernel).evaluate(0, 0.5, 4, f.data());
    return RadialDerivative<2>(alpha)(Point<2>::Zero(), f.data());
  };
  EXPECT_DOUBLE_EQ(at_node("mq", {2, 0}), 2);      // sqrt(c^2 + s) = c + s/(2c) - ...
  EXPECT_DOUBLE_EQ(at_node("gauss", {0, 2}), -8);  // 1 - s/c^2 + ...
  EXPECT_DOUBLE_EQ(at_node("gauss", {2, 2}), 64);  // x^2 y^2/c^4, differentiated: 4/c^4
  EXPECT_DOUBLE_EQ(at_node("imq", {2, 0}), -8);    // 1/c - s/(2 c^3) + ...
  EXPECT_DOUBLE_EQ(at_node("tps", {2, 0}), 0);     // r^4 log r falls faster than r^3
  EXPECT_DOUBLE_EQ(at_node("tps", {1, 2}), 0);
}

/// Weights at the origin by a dense solve with full pivoting in the problem's own unit; phi of an
/// offset as a jet, polynomials up to a degree.
template <class Phi>
Eigen::MatrixXd dense_weights(const Points<2>& nodes, const Derivatives<2>& derivatives, int degree,
                              const Phi& phi_of) {
  constexpr int order = 3;
  using J = Jet<2, order>;
  const Derivatives<2> monomials =
      degree < 0 ? Derivatives<2>{} : Derivatives<2>::between_orders(0, degree);
  const Eigen::Index n = nodes.cols();
  const Eigen::Index all = n + monomials.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(all, all);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(all, derivatives.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Point<2> z = nodes.col(i) - nodes.col(j);
      matrix(i, j) = phi_of(J(z[0]), J(z[1])).value();
    }
    for (int a = 0; a < monomials.size(); ++a) {
      matrix(i, n + a) = monomial<2>(nodes.col(i), monomials[a]);
      matrix(n + a, i) = matrix(i, n + a);
    }
    const J jet = phi_of(J::variable(-nodes(0, i), 0), J::variable(-nodes(1, i), 1));
    for (int d = 0; d < derivatives.size(); ++d) right(i, d) = jet.derivative(derivatives[d]);
  }
  for (int d = 0; d < derivatives.size(); ++d) {
    for (int a = 0; a < monomials.size(); ++a) {
      right(n + a, d) = monomials[a] == derivatives[d] ? factorial<2>(derivatives[d]) : 0;
    }
  }
  return matrix.fullPivLu().solve(right).topRows(n).transpose();
}

TEST(Radial, WeightsEqualThoseOfADenseSolveInTheUnitOfTheProblem) {
  const Derivatives<2> derivatives{{1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 3}};
  for (const std::string kernel : {"gauss", "mq", "imq"}) {
    for (const int degree : {-1, 0, 1, 2}) {
      const std::string spec =
          degree < 0 ? "rbf[kernel=" + kernel + "]"
                     : "rpim[kernel=" + kernel + ",degree=" + std::to_string(degree) + "]";
      const Middle middle = weights_in_the_middle(spec, "nearest[k=15]", 9, derivatives);
      const double c = 2 * middle.spacing;
      const auto phi_of = [&](const auto& x, const auto& y) {
        return phi(kernel, x * x + y * y, c);
      };
      EXPECT_LT(
          difference(middle.weights, dense_weights(middle.nodes, derivatives, degree, phi_of)),
          solved)
          << spec;
    }
  }
}

/// Off the nodes jets may differentiate the thin plate, at them its derivatives vanish.
TEST(Radial, ThinPlateWeightsEqualThoseOfADenseSolve) {
  const Derivatives<2> derivatives{{1, 0}, {2, 0}, {1, 1}};
  for (const int degree : {-1, 1, 2}) {
    const std::string spec =
        degree < 0 ? "rbf[kernel=tps]" : "rpim[kernel=tps,degree=" + std::to_string(degree) + "]";
    const Middle middle = weights_in_the_middle(spec, "nearest[k=15]", 9, derivatives);
    const double radius = middle.nodes.colwise().norm().maxCoeff();
    const auto phi_of = [&](const auto& x, const auto& y) {
      const auto s = (x * x + y * y) / (radius * radius);
      return s.value() == 0 ? 0 * s : phi<std::decay_t<decltype(s)>>("tps", s, 0);
    };
    EXPECT_LT(difference(middle.weights, dense_weights(middle.nodes, derivatives, degree, phi_of)),
              solved)
        << spec;
  }
}

/// With a polynomial through every node the radial functions have no say.
TEST(Radial, RbfFdOnAsManyNodesAsPolynomialTermsIsTheTaylorFit) {
  const Derivatives<2> derivatives = Derivatives<2>::between_orders(1, 2);
  const auto of = [&](const std::string& method) {
    return weights_in_the_middle(method, "nearest[k=6,ties=cut]", 11, derivatives).weights;
  };
  const Eigen::MatrixXd taylor = of("mfpm");
  EXPECT_LT(difference(of("rbf_fd"), taylor), 1e-10);
  EXPECT_LT(difference(of("rbf_fd[phs=5]"), taylor), 1e-10);
  EXPECT_LT(difference(of("rpim[degree=2]"), taylor), 1e-10);
}

TEST(Radial, AShapeTiedToTheSpacingDivergesAndAFixedOneIsIllConditioned) {
  const auto at = [](const std::string& spec, int level) {
    return weights_in_the_middle(spec, "nearest[k=15]", level, {{2, 0}});
  };
  for (const std::string kernel : {"mq", "gauss"}) {
    const Middle coarse = at("rbf[kernel=" + kernel + "]", 11);
    const Middle fine = at("rbf[kernel=" + kernel + "]", 81);
    EXPECT_GT(second_derivative_error(fine), 4 * second_derivative_error(coarse)) << kernel;
    EXPECT_LT(fine.condition, 10 * coarse.condition) << kernel;
  }
  const Middle coarse = at("rbf[shape_length=0.3]", 11);
  const Middle fine = at("rbf[shape_length=0.3]", 41);
  EXPECT_LT(second_derivative_error(fine), second_derivative_error(coarse));
  EXPECT_GT(fine.condition, 1e4 * coarse.condition);
  try {
    at("rbf[shape_length=300]", 41);
    ADD_FAILURE() << "functions that are flat cannot be told apart";
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("smaller shape"), std::string::npos);
  }
}

TEST(Radial, SpecsSayWhatDoesNotGoTogether) {
  EXPECT_NE(make_method<2>("rbf[kernel=tps,power=2]").made->unsupported({{2, 0}}).find("power"),
            std::string::npos);
  EXPECT_EQ(make_method<2>("rbf[kernel=tps,power=4]").made->unsupported({{2, 0}, {1, 2}}), "");
  EXPECT_NE(make_method<2>("rbf[kernel=tps,power=4]").made->unsupported({{2, 2}}), "");
  EXPECT_THROW(make_method<2>("rbf[kernel=tps,power=3]"), UsageError);
  EXPECT_THROW(make_method<2>("rbf[shape=3,shape_length=0.1]"), UsageError);
  EXPECT_THROW(make_method<2>("rbf[kernel=tps,shape=3]"), UsageError);
  EXPECT_FALSE(make_method<2>("rbf[shape_length=0.1]").made->promises().scale_covariant);
  EXPECT_FALSE(make_method<2>("rbf[shape_length=0.1]").made->needs().spacing);
  EXPECT_TRUE(make_method<2>("rbf").made->needs().spacing);
}

}  // namespace
}  // namespace strongpoint
