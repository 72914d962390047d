#include "problems/core/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "problems/core/sparse_growth.hpp"
#include "studies/support/waves.hpp"
#include "tests/matrix_motion.hpp"

namespace strongpoint {
namespace {

/// Sorted by real part, then imaginary part.
Eigen::VectorXcd sorted(Eigen::VectorXcd values) {
  std::sort(values.begin(), values.end(), [](std::complex<double> a, std::complex<double> b) {
    return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag();
  });
  return values;
}

/// Round-off of the QR algorithm, relative to the largest eigenvalue, for well-conditioned ones.
constexpr double dense_tolerance = 1e-11;

TEST(DenseEigenvalues, AreThoseOfThreePointDifferencesInClosedForm) {
  constexpr int n = 60;
  Eigen::MatrixXd matrix = -2 * Eigen::MatrixXd::Identity(n, n);
  matrix.diagonal(1).setOnes();
  matrix.diagonal(-1).setOnes();
  const Eigen::VectorXcd values = sorted(dense_eigenvalues(MatrixMotion(matrix)));
  for (int k = 0; k < n; ++k) {
    const double angle = (n - k) * std::numbers::pi / (2 * (n + 1));
    EXPECT_NEAR(values[k].real(), -4 * std::sin(angle) * std::sin(angle), 4 * dense_tolerance);
    EXPECT_EQ(values[k].imag(), 0);
  }
}

TEST(DenseEigenvalues, WithEigenvectorsSatisfyTheirEquationAlsoWhereComplex) {
  constexpr int n = 41;  // odd: at least one real eigenvalue beside complex pairs
  std::mt19937 numbers(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const MatrixMotion motion(
      Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index) { return uniform(numbers); }));
  const EigenPairs pairs = dense_eigenpairs(motion);
  const Eigen::MatrixXcd residual =
      motion.matrix() * pairs.vectors - pairs.vectors * pairs.values.asDiagonal();
  EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((pairs.vectors.colwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
  EXPECT_GT(pairs.values.imag().maxCoeff(), 0.1);
  const Eigen::VectorXcd alone = sorted(dense_eigenvalues(motion));
  const Eigen::VectorXcd theirs = sorted(motion.matrix().eigenvalues());
  EXPECT_LT((alone - sorted(pairs.values)).cwiseAbs().maxCoeff(), dense_tolerance);
  EXPECT_LT((alone - theirs).cwiseAbs().maxCoeff(), dense_tolerance);
}

TEST(DenseEigenvalues, OfAnOperatorThatIsNotFiniteAreRefused) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(3, 3);
  matrix(1, 2) = std::nan("");
  EXPECT_THROW(dense_eigenvalues(MatrixMotion(matrix)), CaseError);
}

TEST(GrowthRate, IsTheLargestRealPartOfTheRoots) {
  // sqrt(-9) = 3i, sqrt(4) = 2, and (1 + 2i)^2 = -3 + 4i grows at 1.
  EXPECT_DOUBLE_EQ(growth_rate(Eigen::Vector2cd(-9, std::complex<double>(-3, 4))), 1);
  EXPECT_DOUBLE_EQ(growth_rate(Eigen::Vector2cd(-9, 4)), 2);
  EXPECT_DOUBLE_EQ(growth_rate(Eigen::Vector2cd(-9, -4)), 0);
}

/// A problem of waves with what came of it.
template <int Dim>
struct Case {
  NamedProblem named;
  Waves<Dim> waves;
  const Motion& motion() const { return *waves.motion; }
};

template <int Dim>
Case<Dim> make_case(const std::string& problem, const std::string& method,
                    const std::string& stencil, int level) {
  Case<Dim> result{make_problem(problem), {}};
  const auto& made = std::get<std::unique_ptr<Problem<Dim>>>(result.named.made);
  StageTimes times;
  result.waves = make_waves<Dim>(
      dynamic_cast<const TransientProblem<Dim>&>(*made),
      {problem, method, stencil, "grid", "collocation", "umfpack", level}, {}, times);
  return result;
}

/// The pairs of one list beside those of another, by |eigenvalue|.
void expect_near(const Eigen::VectorXcd& few, Eigen::VectorXcd all, double tolerance,
                 const std::function<bool(double, double)>& before) {
  std::sort(all.begin(), all.end(), [&](std::complex<double> a, std::complex<double> b) {
    return before(std::abs(a), std::abs(b));
  });
  for (Eigen::Index i = 0; i < few.size(); ++i) {
    EXPECT_NEAR(std::abs(few[i]) / std::abs(all[i]), 1, tolerance) << i;
    EXPECT_NEAR(few[i].real() / all[i].real(), 1, tolerance) << i;
  }
}

/// Round-off of dense algebra is relative to the largest eigenvalue.
constexpr double partial_tolerance = 1e-8;

void expect_few_as_dense(const Motion& motion) {
  const Eigen::VectorXcd all = dense_eigenvalues(motion);
  const EigenPairs lowest = lowest_modes(motion, 10);
  expect_near(lowest.values, all, partial_tolerance, std::less<>());
  EXPECT_LT(eigen_residual(motion, lowest), 1e-6);
  const EigenPairs largest = largest_modes(motion, 2);
  expect_near(largest.values, all, partial_tolerance, std::greater<>());
  EXPECT_LT(eigen_residual(motion, largest), 1e-6);
  constexpr double three_digits = 1e-3;
  EXPECT_NEAR(spectral_radius(motion) / all.cwiseAbs().maxCoeff(), 1, three_digits);
}

TEST(FewEigenvalues, AreThoseOfDenseAlgebraInABar) {
  expect_few_as_dense(make_case<1>("bar_1d", "mfpm", "nearest[k=3]", 201).motion());
}

TEST(FewEigenvalues, AreThoseOfDenseAlgebraInAPlaneBar) {
  expect_few_as_dense(make_case<2>("bar_2d", "lsfdm", "nearest[k=15]", 31).motion());
}

TEST(SlowFewEigenvalues, AreThoseOfDenseAlgebraForTwoThousandUnknowns) {
  const Case<1> line = make_case<1>("bar_1d", "mfpm", "nearest[k=3]", 2002);
  EXPECT_EQ(line.motion().size(), 2000);
  expect_few_as_dense(line.motion());
  const Case<2> plane = make_case<2>("bar_2d", "lsfdm", "nearest[k=15]", 76);
  EXPECT_EQ(plane.motion().size(), 2072);
  expect_few_as_dense(plane.motion());
}

TEST(FewEigenvalues, OfNoneOrTooManyAreRefused) {
  const MatrixMotion motion(Eigen::MatrixXd::Identity(3, 3));
  EXPECT_THROW(lowest_modes(motion, 0), UsageError);
  EXPECT_THROW(largest_modes(motion, 4), UsageError);
  EXPECT_EQ(lowest_modes(motion, 3).values.size(), 3);
}

/// The rate is accepted when its error is below about two per cent.
constexpr double growth_tolerance = 0.02;

TEST(FastestGrowth, IsThatOfDenseAlgebra) {
  for (const auto& [method, stencil] :
       {std::pair{"mfpm", "nearest[k=9]"}, {"mfpm", "block"}, {"lsfdm", "nearest[k=15]"}}) {
    const Case<2> plane = make_case<2>("bar_2d", method, stencil, 51);
    const Motion& motion = plane.motion();
    const FoundGrowth growth = find_growth(motion, spectral_radius(motion), 50000);
    const double dense = growth_rate(dense_eigenvalues(motion));
    EXPECT_NEAR(growth.rate / dense, 1, growth_tolerance) << method << stencil;
    EXPECT_NEAR(std::sqrt(growth.eigenvalue).real() / growth.rate, 1, 1e-12);
    EXPECT_LT(growth.residual, 0.02);
    const EigenPairs pair{Eigen::VectorXcd::Constant(1, growth.eigenvalue), growth.vector};
    EXPECT_NEAR(eigen_residual(motion, pair), growth.residual, 1e-9);
    EXPECT_LE(growth.products, 50000);
  }
}

TEST(FastestGrowth, IsNoneWithABoundWhereNothingGrows) {
  const Case<1> line = make_case<1>("bar_1d", "mfpm", "nearest[k=3]", 101);
  const FoundGrowth growth = find_growth(line.motion(), spectral_radius(line.motion()), 20000);
  EXPECT_EQ(growth.rate, 0);
  EXPECT_EQ(growth.vector.size(), 0);
  EXPECT_GT(growth.bound, 0);
  EXPECT_LT(growth.bound, 0.2);
}

TEST(FastestGrowth, IsFoundForAMotionThatRunsAway) {
  Eigen::MatrixXd matrix = -Eigen::Vector4d(1, 4, 9, 16).asDiagonal().toDenseMatrix();
  matrix(1, 1) = 0.25;  // grows as exp(t / 2) without vibrating
  const FoundGrowth growth = find_growth(MatrixMotion(matrix), 16, 1000);
  EXPECT_NEAR(growth.rate, 0.5, 1e-9);
}

TEST(EigenvectorCondition, IsOneOfASymmetricAndKnownOfATriangularMatrix) {
  EXPECT_NEAR(
      eigenvector_condition(dense_eigenpairs(MatrixMotion(Eigen::Matrix2d{{-2, 1}, {1, -2}}))), 1,
      1e-12);
  // Eigenvectors (1, 0) and (1, 1) / sqrt(2): singular values sqrt(1 +- 1/sqrt(2)).
  const double c = std::sqrt(0.5);
  EXPECT_NEAR(
      eigenvector_condition(dense_eigenpairs(MatrixMotion(Eigen::Matrix2d{{-2, 1}, {0, -1}}))),
      std::sqrt((1 + c) / (1 - c)), 1e-12);
  // A skew pair is normal: complex eigenvectors, condition 1.
  EXPECT_NEAR(
      eigenvector_condition(dense_eigenpairs(MatrixMotion(Eigen::Matrix2d{{-3, 2}, {-2, -3}}))), 1,
      1e-12);
}

}  // namespace
}  // namespace strongpoint
