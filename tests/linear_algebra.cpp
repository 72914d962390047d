// Local solvers, assembly and global solvers against dense linear algebra.
#include <array>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "methods/core/condition.hpp"
#include "methods/core/error.hpp"
#include "methods/core/local_solvers.hpp"
#include "methods/core/polyharmonic.hpp"
#include "problems/core/assembly.hpp"
#include "problems/core/random.hpp"
#include "problems/core/solvers.hpp"

namespace strongpoint {
namespace {

Eigen::MatrixXd random_matrix(int rows, int cols, std::mt19937_64& generator) {
  Eigen::MatrixXd matrix(rows, cols);
  for (double& entry : matrix.reshaped()) entry = 2 * uniform01(generator) - 1;
  return matrix;
}

TEST(LocalSolvers, QrReproducesTheMatrixItsTransposeAndItsRank) {
  std::mt19937_64 generator(7);
  HouseholderQr qr;
  for (const auto& [rows, cols] : {std::pair{9, 5}, {5, 5}, {30, 14}, {6, 1}}) {
    const Eigen::MatrixXd a = random_matrix(rows, cols, generator);
    Eigen::Map<Eigen::MatrixXd>(qr.prepare(rows, cols), rows, cols) = a;
    ASSERT_TRUE(qr.factorise(1e-12));
    // w = Q R^-T g is the shortest solution of A^T w = g.
    const Eigen::VectorXd g = random_matrix(cols, 1, generator);
    Eigen::VectorXd w = Eigen::VectorXd::Zero(rows);
    w.head(cols) = g;
    qr.solve_transposed_r({w.data(), w.data() + cols});
    qr.apply_q({w.data(), w.data() + rows});
    EXPECT_LT((a.transpose() * w - g).norm(), 1e-12);
    EXPECT_LT((w - a * (a.transpose() * a).inverse() * g).norm(), 1e-9);
    const Eigen::VectorXd before = w;
    qr.apply_q({w.data(), w.data() + rows});
    qr.apply_q_transposed({w.data(), w.data() + rows});
    EXPECT_LT((w - before).norm(), 1e-13);
  }
  Eigen::MatrixXd flat = random_matrix(9, 4, generator);
  flat.col(3) = flat.col(0) - 2 * flat.col(1);
  Eigen::Map<Eigen::MatrixXd>(qr.prepare(9, 4), 9, 4) = flat;
  EXPECT_FALSE(qr.factorise(1e-12));
}

TEST(LocalSolvers, LdltSolvesDefiniteMatricesOfEitherSignAndRefusesOthers) {
  std::mt19937_64 generator(11);
  Ldlt ldlt;
  for (const double sign : {1.0, -1.0}) {
    const Eigen::MatrixXd root = random_matrix(12, 6, generator);
    const Eigen::MatrixXd a = sign * root.transpose() * root;
    Eigen::Map<Eigen::MatrixXd>(ldlt.prepare(6), 6, 6) = a;
    ASSERT_TRUE(ldlt.factorise(1e-10));
    const Eigen::VectorXd b = random_matrix(6, 1, generator);
    Eigen::VectorXd x = b;
    ldlt.solve({x.data(), x.data() + 6});
    EXPECT_LT((a * x - b).norm(), 1e-10);
  }
  Eigen::Map<Eigen::MatrixXd>(ldlt.prepare(2), 2, 2) << 1, 2, 2, 1;
  EXPECT_FALSE(ldlt.factorise(1e-10));
}

TEST(LocalSolvers, LuSolvesWhatNeedsPivotingAndRefusesSingularMatrices) {
  std::mt19937_64 generator(12);
  Lu lu;
  for (const int n : {1, 2, 7, 20}) {
    Eigen::MatrixXd a = random_matrix(n, n, generator);
    if (n > 1) a.diagonal().setZero();
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(lu.prepare(n), n, n) = a;
    ASSERT_TRUE(lu.factorise(1e-14));
    const Eigen::VectorXd b = random_matrix(n, 1, generator);
    Eigen::VectorXd x = b;
    lu.solve({x.data(), x.data() + n});
    EXPECT_LT((a * x - b).norm(), 1e-11) << n;
  }
  Eigen::Map<Eigen::Matrix3d>(lu.prepare(3)) << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  EXPECT_FALSE(lu.factorise(1e-14));
}

TEST(Condition, OfKnownMatrices) {
  const Eigen::MatrixXd diagonal = Eigen::Vector3d(4, 2, 0.5).asDiagonal();
  EXPECT_DOUBLE_EQ(condition_number(diagonal, ConditionNorm::two), 8);
  EXPECT_DOUBLE_EQ(condition_number(diagonal, ConditionNorm::one), 8);
  Eigen::Matrix2d hilbert;
  hilbert << 1, 0.5, 0.5, 1.0 / 3;
  EXPECT_NEAR(condition_number(hilbert, ConditionNorm::two), 19.28147006790397, 1e-12);
  EXPECT_NEAR(condition_number(hilbert, ConditionNorm::one), 27, 1e-12);
  EXPECT_TRUE(std::isinf(condition_number(Eigen::Matrix2d::Zero(), ConditionNorm::two)));
}

/// r^5 in 2D: d2/dx2 = 5 r^3 + 15 r x^2, d2/dxdy = 15 r x y, lap = 25 r^3.
TEST(Polyharmonic, DerivativesOfRadialPowersEqualClosedForms) {
  const Point<2> x(0.3, -0.7);
  const double r = x.norm();
  const auto at = [](int power, const MultiIndex<2>& alpha, const Point<2>& place) {
    std::array<double, 5> f{};
    RadialFunction(RadialFunction::Form::odd_power, power)
        .evaluate(place.squaredNorm(), 0, 4, f.data());
    return RadialDerivative<2>(alpha)(place, f.data());
  };
  EXPECT_NEAR(at(5, {0, 0}, x), std::pow(r, 5), 1e-14);
  EXPECT_NEAR(at(5, {1, 0}, x), 5 * std::pow(r, 3) * x[0], 1e-13);
  EXPECT_NEAR(at(5, {2, 0}, x), 5 * std::pow(r, 3) + 15 * r * x[0] * x[0], 1e-13);
  EXPECT_NEAR(at(5, {1, 1}, x), 15 * r * x[0] * x[1], 1e-13);
  EXPECT_NEAR(at(5, {2, 0}, x) + at(5, {0, 2}, x), 25 * std::pow(r, 3), 1e-13);
  // Differences of one order give the next.
  constexpr double h = 1e-6;
  const Point<2> step(h, 0);
  EXPECT_NEAR(at(7, {2, 1}, x), (at(7, {1, 1}, x + step) - at(7, {1, 1}, x - step)) / (2 * h),
              1e-7);
  EXPECT_EQ(at(5, {2, 2}, Point<2>::Zero()), 0);
}

/// Two nodes, one field, two derivatives, one evaluation point off the nodes.
TEST(Assembly, WritesTheSumOfTermsWhateverTheirPoints) {
  Weights weights;
  weights.per_entry = 2;
  weights.offsets = {0, 2, 4};
  weights.columns = {1, 0, 0, 1};
  weights.values = {1, 10, 2, 20, 3, 30, 4, 40};
  EquationList equations;
  const Derivatives<1> derivatives{{1}, {2}};
  EquationWriter<1> write(equations, derivatives);
  write.at(0);
  write.add(0, {1}, 5);
  write.add(0, {2}, 1);
  write.equals(30);
  write.at(0);
  write.add(0, {1}, 1);
  write.at(1);
  write.add(0, {1}, 1);
  write.add(0, {0}, 100);
  write.equals(7);
  const LinearSystem system = assemble(equations, weights, {.count = 2}, 1);
  // Row 0: columns 0 and 1 hold 5*2+20 = 30 and 5*1+10 = 15, scaled by 30.
  EXPECT_EQ(system.columns, (LargeArray<std::int64_t>{0, 1, 0, 1}));
  EXPECT_DOUBLE_EQ(system.values[0], 1);
  EXPECT_DOUBLE_EQ(system.values[1], 0.5);
  EXPECT_DOUBLE_EQ(system.right_hand_side[0], 1);
  // Row 1: 2+3 = 5, and 1+4+100 = 105, scaled by 105.
  EXPECT_DOUBLE_EQ(system.values[2], 5.0 / 105);
  EXPECT_DOUBLE_EQ(system.values[3], 1);
  EXPECT_DOUBLE_EQ(system.right_hand_side[1], 7.0 / 105);
}

TEST(Assembly, NamesTheNodeOfAnEmptyRow) {
  Weights weights;
  weights.per_entry = 1;
  weights.offsets = {0, 0};
  EquationList equations;
  const Derivatives<1> derivatives{{1}};
  EquationWriter<1> write(equations, derivatives);
  write.add(0, {1}, 1);
  write.equals(0);
  try {
    assemble(equations, weights, {.count = 1}, 1);
    FAIL() << "an empty row went through";
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("node 0"), std::string::npos) << error.what();
  }
}

LinearSystem dense_system(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& rhs) {
  LinearSystem system;
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.cols(); ++j) {
      system.columns.push_back(j);
      system.values.push_back(matrix(i, j));
    }
    system.offsets.push_back(static_cast<std::int64_t>(system.columns.size()));
  }
  system.right_hand_side = rhs;
  return system;
}

TEST(Solvers, EverySolverAgreesWithDenseLuAndRefusesSingularSystems) {
  std::mt19937_64 generator(3);
  const Eigen::MatrixXd matrix = random_matrix(40, 40, generator);
  const Eigen::VectorXd rhs = random_matrix(40, 1, generator);
  Eigen::MatrixXd singular = matrix;
  singular.row(7) = singular.row(3);
  // Round-off, or the tolerance of an iterative solver, and what the matrix makes of it in x.
  constexpr double direct = 1e-14;
  constexpr double iterative = 1e-9;
  const double condition = matrix.norm() * matrix.inverse().norm();
  for (const EntryInfo& solver : solvers()) {
    const double tolerance = is_iterative(solver.name) ? iterative : direct;
    const LinearSolution solution = solve(dense_system(matrix, rhs), solver.name);
    const Eigen::VectorXd expected = matrix.partialPivLu().solve(rhs);
    EXPECT_LT((solution.x - expected).norm(), tolerance * condition * expected.norm())
        << solver.name;
    EXPECT_LT(solution.residual, tolerance) << solver.name;
    EXPECT_THROW(solve(dense_system(singular, rhs), solver.name), CaseError) << solver.name;
  }
}

}  // namespace
}  // namespace strongpoint
