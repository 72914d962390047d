// Kernel estimates and projections of the Taylor series against their formulas written out.
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "methods/core/local_solvers.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Round-off of sums over about 30 nodes after a solve of condition up to 1e4, relative.
constexpr double solved = 1e-10;
/// Round-off of a closed form; the kernel's norm is integrated to as much.
constexpr double closed_form = 1e-11;

TEST(Projections, LuSolvesItsSystemAndTheTransposedOne) {
  constexpr int n = 7;
  Eigen::MatrixXd matrix(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) matrix(i, j) = i == j ? 0 : std::sin(3.0 * i + 7 * j * j);
  }
  Lu lu;
  Eigen::Map<Eigen::MatrixXd>(lu.prepare(n), n, n) = matrix.transpose();
  ASSERT_TRUE(lu.factorise(1e-12));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, 1, 2);
  Eigen::VectorXd x = b;
  lu.solve({x.data(), x.data() + n});
  EXPECT_LT((matrix * x - b).norm(), 1e-13 * x.norm() * matrix.norm());
  x = b;
  lu.solve_transposed({x.data(), x.data() + n});
  EXPECT_LT((matrix.transpose() * x - b).norm(), 1e-13 * x.norm() * matrix.norm());
  matrix.row(4) = matrix.row(1) + 2 * matrix.row(6);
  Eigen::Map<Eigen::MatrixXd>(lu.prepare(n), n, n) = matrix.transpose();
  EXPECT_FALSE(lu.factorise(1e-12));
}

/// The Gauss bell of smoothing length h cut at 2.6 h and its derivatives, each coordinate's factor
/// a Hermite polynomial: an independent computation.
template <int Dim>
double bell(const Point<Dim>& x, double h, const MultiIndex<Dim>& alpha) {
  constexpr double cut = 2.6;
  if (x.norm() > cut * h) return 0;
  const double pi = std::numbers::pi;
  const double in_1d = std::sqrt(pi) * std::erf(cut);
  const double in_2d = pi * (1 - std::exp(-cut * cut));
  double result = std::exp(-x.squaredNorm() / (h * h)) / (Dim == 1 ? in_1d * h : in_2d * h * h);
  for (int c = 0; c < Dim; ++c) {
    const double q = x[c] / h;
    if (alpha[c] == 1) result *= -2 * q / h;
    if (alpha[c] == 2) result *= (4 * q * q - 2) / (h * h);
  }
  return result;
}

/// Compares the weights of the scene's method at every wanted anchor with other ones.
template <int Dim>
void expect_weights(
    const TestScene<Dim>& scene, const Derivatives<Dim>& derivatives, double tolerance,
    const std::function<Eigen::MatrixXd(int point, std::span<const int> nodes)>& expected) {
  const Weights weights = scene.method->weights(scene.sites, scene.stencils, derivatives);
  for (int p = 0; p < weights.size(); ++p) {
    if (weights.nodes(p).empty()) continue;
    const Eigen::MatrixXd other = expected(p, weights.nodes(p));
    for (int d = 0; d < derivatives.size(); ++d) {
      EXPECT_LT((weights.row(p).row(d) - other.row(d)).cwiseAbs().maxCoeff(),
                tolerance * other.row(d).cwiseAbs().maxCoeff())
          << name_of<Dim>(derivatives[d]) << " at point " << p;
    }
  }
}

/// Rows V_j D^alpha W(sign (x_j - x)), one for each derivative.
template <int Dim>
Eigen::MatrixXd kernel_rows(const TestScene<Dim>& scene, const Point<Dim>& x, int anchor,
                            std::span<const int> nodes, const Derivatives<Dim>& derivatives,
                            double sign) {
  Eigen::MatrixXd rows(derivatives.size(), nodes.size());
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Point<Dim> offset = sign * (scene.sites.nodes.col(nodes[j]) - x);
    for (int d = 0; d < derivatives.size(); ++d) {
      rows(d, static_cast<Eigen::Index>(j)) =
          scene.sites.volumes[nodes[j]] *
          bell<Dim>(offset, 1.2 * scene.sites.spacing[anchor], derivatives[d]);
    }
  }
  return rows;
}

/// (terms, n) Taylor terms (x_j - x)^s / s!.
template <int Dim>
Eigen::MatrixXd taylor_rows(const TestScene<Dim>& scene, int anchor, std::span<const int> nodes,
                            const Derivatives<Dim>& terms) {
  Eigen::MatrixXd rows(terms.size(), nodes.size());
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Point<Dim> offset = scene.sites.nodes.col(nodes[j]) - scene.sites.anchors.col(anchor);
    for (int s = 0; s < terms.size(); ++s) {
      rows(s, static_cast<Eigen::Index>(j)) =
          monomial<Dim>(offset, terms[s]) / factorial<Dim>(terms[s]);
    }
  }
  return rows;
}

template <int Dim>
void check_sph() {
  TestScene<Dim> scene = make_scene<Dim>("sph", "perturbed[amount=0.2]", 12, 5);
  scene.sites.points.array() += 0.011;  // off the anchors: no node is needed there
  const Derivatives<Dim> all = Derivatives<Dim>::between_orders(0, 2);
  expect_weights<Dim>(scene, all, closed_form, [&](int p, std::span<const int> nodes) {
    return kernel_rows<Dim>(scene, scene.sites.points.col(p), p, nodes, all, -1);
  });
}
TEST(Projections, SphIsTheSumOfKernelDerivativesTimesVolumesAtAnyPoint) {
  check_sph<1>();
  check_sph<2>();
}

TEST(Projections, CspmIn1DIsTheQuotientsOfItsSource) {
  const TestScene<1> scene = make_scene<1>("cspm", "perturbed[amount=0.2]", 15, 1);
  const Derivatives<1> all{{1}, {2}};
  expect_weights<1>(scene, all, solved, [&](int p, std::span<const int> nodes) {
    Eigen::MatrixXd w = kernel_rows<1>(scene, scene.sites.anchors.col(p), p, nodes, all, 1);
    const Eigen::MatrixXd x = taylor_rows<1>(scene, p, nodes, all);
    Eigen::RowVectorXd first = w.row(0) / w.row(0).dot(x.row(0));
    first[0] -= first.sum();  // the centre, the first of its stencil
    Eigen::RowVectorXd second = w.row(1);
    second[0] -= second.sum();
    second = (second - first * w.row(1).dot(x.row(0))) / w.row(1).dot(x.row(1));
    w << first, second;
    return w;
  });
}

TEST(Projections, CspmIn2DSolvesForFirstAndThenForSecondDerivatives) {
  const TestScene<2> scene = make_scene<2>("cspm", "perturbed[amount=0.2]", 11, 4);
  const Derivatives<2> all = Derivatives<2>::between_orders(1, 2);
  expect_weights<2>(scene, all, solved, [&](int p, std::span<const int> nodes) {
    Eigen::MatrixXd w = kernel_rows<2>(scene, scene.sites.anchors.col(p), p, nodes, all, 1);
    const Eigen::MatrixXd a = w * taylor_rows<2>(scene, p, nodes, all).transpose();
    w.col(0) -= w.rowwise().sum().eval();
    w.topRows(2) = a.topLeftCorner(2, 2).lu().solve(w.topRows(2)).eval();
    w.bottomRows(3) -= a.bottomLeftCorner(3, 2) * w.topRows(2);
    w.bottomRows(3) = a.bottomRightCorner(3, 3).lu().solve(w.bottomRows(3)).eval();
    return w;
  });
}

TEST(Projections, CspmEstimatesTheValueByTheNormalisedKernelWhenAskedTo) {
  const TestScene<2> scene = make_scene<2>("cspm[value=kernel]", "perturbed", 11, 4);
  EXPECT_FALSE(scene.method->promises().interpolates);
  const Derivatives<2> value{{0, 0}};
  expect_weights<2>(scene, value, solved, [&](int p, std::span<const int> nodes) {
    const Eigen::MatrixXd w = kernel_rows<2>(scene, scene.sites.anchors.col(p), p, nodes, value, 1);
    return Eigen::MatrixXd(w / w.sum());
  });
  const Derivatives<2> others = Derivatives<2>::between_orders(1, 2);
  const Weights nodal = make_method<2>("cspm").made->weights(scene.sites, scene.stencils, others);
  const Weights kernel = scene.method->weights(scene.sites, scene.stencils, others);
  EXPECT_EQ(nodal.values, kernel.values) << "derivatives take the nodal value, (1.18)";
}

template <int Dim>
void check_msph() {
  const TestScene<Dim> scene = make_scene<Dim>("msph", "perturbed[amount=0.2]", 12, 5);
  const Derivatives<Dim> all = Derivatives<Dim>::between_orders(0, 2);
  expect_weights<Dim>(scene, all, solved, [&](int p, std::span<const int> nodes) {
    const Eigen::MatrixXd w = kernel_rows<Dim>(scene, scene.sites.anchors.col(p), p, nodes, all, 1);
    const Eigen::MatrixXd a = w * taylor_rows<Dim>(scene, p, nodes, all).transpose();
    return Eigen::MatrixXd(a.fullPivLu().solve(w));
  });
}
TEST(Projections, MsphSolvesForTheValueAndAllDerivativesAtOnce) {
  check_msph<1>();
  check_msph<2>();
}

/// Largest error of second derivatives of x^2 + x y, at interior and at boundary nodes.
std::array<double, 2> errors_on_a_quadratic(const std::string& method) {
  const TestScene<2> scene = make_scene<2>(method, "grid", 11, 1);
  const Derivatives<2> second = Derivatives<2>::between_orders(2, 2);
  const Eigen::Vector3d exact(2, 1, 0);
  const Weights weights = scene.method->weights(scene.sites, scene.stencils, second);
  std::array<double, 2> worst{};
  for (int p = 0; p < weights.size(); ++p) {
    Eigen::VectorXd sum = -exact;
    for (std::size_t j = 0; j < weights.nodes(p).size(); ++j) {
      const Point<2> x = scene.sites.nodes.col(weights.nodes(p)[j]);
      sum += weights.row(p).col(static_cast<Eigen::Index>(j)) * (x[0] * x[0] + x[0] * x[1]);
    }
    const double depth =
        scene.cloud.nodes.col(p).array().min(1 - scene.cloud.nodes.col(p).array()).minCoeff();
    if (depth > 0 && depth < 0.35) continue;  // stencils cut by the boundary
    double& zone = worst[depth > 0 ? 0 : 1];
    zone = std::max(zone, sum.cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(Projections, CspmLosesSecondDerivativesOfQuadraticsWhereItsStencilsAreCut) {
  const auto [inside, boundary] = errors_on_a_quadratic("cspm");
  EXPECT_LT(inside, 1e-9);
  EXPECT_GT(boundary, 0.1);
  EXPECT_LT(errors_on_a_quadratic("msph")[1], 1e-9);
}

}  // namespace
}  // namespace strongpoint
