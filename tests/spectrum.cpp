#include "problems/core/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// A motion given by its matrix.
class MatrixMotion final : public Motion {
 public:
  explicit MatrixMotion(Eigen::MatrixXd matrix)
      : matrix_(std::move(matrix)), load_(Eigen::VectorXd::Zero(matrix_.rows())) {}
  int size() const override { return static_cast<int>(matrix_.rows()); }
  void apply(const Eigen::VectorXd& u, Eigen::VectorXd& product) const override {
    product.noalias() = matrix_ * u;
  }
  const Eigen::VectorXd& load() const override { return load_; }
  std::unique_ptr<ShiftedMotion> shifted(double factor) const override {
    return std::make_unique<Inverse>(Eigen::MatrixXd::Identity(size(), size()) - factor * matrix_);
  }
  const Eigen::MatrixXd& matrix() const { return matrix_; }

 private:
  class Inverse final : public ShiftedMotion {
   public:
    explicit Inverse(const Eigen::MatrixXd& matrix) : factors_(matrix) {}
    void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const override {
      x = factors_.solve(b);
    }

   private:
    Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
  };
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd load_;
};

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

}  // namespace
}  // namespace strongpoint
