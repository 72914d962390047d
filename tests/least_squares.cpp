// Solvers of systems with more equations than unknowns against dense linear algebra.
#include <gtest/gtest.h>

#include "tests/linear_systems.hpp"

namespace strongpoint {
namespace {

const std::vector<std::string> able{"spqr", "normal"};
const std::vector<std::string> square_alone{"umfpack", "sparse_lu", "bicgstab"};

void has(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << "'" << message << "' lacks '" << part << "'";
}

/// A tall sparse matrix of full rank: a diagonal lies on top.
Eigen::MatrixXd tall_matrix(int rows, int columns, std::mt19937_64& generator) {
  Eigen::MatrixXd matrix = sparse_matrix(rows, columns, 0.1, generator);
  matrix.diagonal().array() += 2;
  return matrix;
}

TEST(LeastSquares, AgreesWithDenseQr) {
  std::mt19937_64 generator(1);
  const Eigen::MatrixXd matrix = tall_matrix(150, 60, generator);
  const Eigen::VectorXd b = random_vector(150, generator);
  const Eigen::VectorXd expected = matrix.householderQr().solve(b);
  for (const std::string& solver : able) {
    const LinearSolution solution = solve(system_of(matrix, b), solver);
    // Round-off of a well conditioned fit.
    EXPECT_LT((solution.x - expected).norm(), 1e-13 * expected.norm()) << solver;
    EXPECT_LT(solution.residual, 1e-14) << solver;
    EXPECT_GT((b - matrix * solution.x).norm(), 1) << solver;
  }
}

TEST(LeastSquares, SolvesConsistentSystemsWhateverTheDirectionOfTheRoundOff) {
  std::mt19937_64 generator(2);
  const Eigen::MatrixXd matrix = tall_matrix(120, 80, generator);
  const Eigen::VectorXd x = random_vector(80, generator);
  for (const std::string& solver : able) {
    const LinearSolution solution = solve(system_of(matrix, matrix * x), solver);
    EXPECT_LT((solution.x - x).norm(), 1e-12) << solver;
    EXPECT_LT(solution.residual, 1e-14) << solver;
  }
}

TEST(LeastSquares, RefinementOfNormalEquationsKeepsTheDigitsThatSquaringLoses) {
  std::mt19937_64 generator(3);
  // Columns of lengths from 1 to 1e-5: the normal equations lose ten digits of sixteen.
  Eigen::MatrixXd matrix = tall_matrix(60, 30, generator);
  const Eigen::MatrixXd q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(sparse_matrix(30, 30, 1, generator)).householderQ();
  matrix = matrix * q *
           Eigen::VectorXd::LinSpaced(30, 0, -5)
               .unaryExpr([](double p) { return std::pow(10, p); })
               .asDiagonal() *
           q.transpose();
  const Eigen::VectorXd x = random_vector(30, generator);
  const Eigen::VectorXd b = matrix * x;
  const Eigen::MatrixXd gram = matrix.transpose() * matrix;
  const double unrefined = (gram.llt().solve(matrix.transpose() * b) - x).norm() / x.norm();
  const double refined = (solve(system_of(matrix, b), "normal").x - x).norm() / x.norm();
  EXPECT_GT(unrefined, 1e-8);
  // The condition times round-off, 1e5 * 1e-16, and what one step leaves: the square of the first.
  EXPECT_LT(refined, 1e-9);
}

TEST(LeastSquares, ServesSquareSystemsToo) {
  std::mt19937_64 generator(4);
  const Eigen::MatrixXd matrix = dominant_matrix(50, 0.2, generator);
  const Eigen::VectorXd b = random_vector(50, generator);
  for (const std::string& solver : able) {
    const LinearSolution solution = solve(system_of(matrix, b), solver);
    EXPECT_LT((solution.x - matrix.partialPivLu().solve(b)).norm(), 1e-13) << solver;
  }
}

TEST(LeastSquares, RefusesDeficientRank) {
  std::mt19937_64 generator(5);
  Eigen::MatrixXd matrix = tall_matrix(40, 20, generator);
  const Eigen::VectorXd b = random_vector(40, generator);
  for (const std::string& solver : able) {
    Eigen::MatrixXd dependent = matrix;
    dependent.col(7) = dependent.col(3) + 2 * dependent.col(11);
    has(message_of<CaseError>([&] { solve(system_of(dependent, b), solver); }), solver);
    has(message_of<CaseError>([&] { solve(system_of(dependent, b), solver); }), "deficient rank");
    Eigen::MatrixXd empty = matrix;
    empty.col(5).setZero();
    has(message_of<CaseError>([&] { solve(system_of(empty, b), solver); }), "deficient rank");
  }
}

TEST(LeastSquares, SquareSolversSayWhichSolverToTake) {
  std::mt19937_64 generator(6);
  const LinearSystem tall = system_of(tall_matrix(9, 6, generator), random_vector(9, generator));
  for (const std::string& solver : square_alone) {
    const std::string message = message_of<SkipCase>([&] { solve(tall, solver); });
    has(message, solver);
    has(message, "9 equations for 6 unknowns");
    has(message, "spqr or normal");
  }
}

TEST(LeastSquares, EverySolverRefusesFewerEquationsThanUnknowns) {
  std::mt19937_64 generator(7);
  const LinearSystem wide =
      system_of(sparse_matrix(5, 8, 1, generator), random_vector(5, generator));
  for (const EntryInfo& solver : solvers()) {
    has(message_of<CaseError>([&] { solve(wide, solver.name); }), "5 equations for 8 unknowns");
  }
}

}  // namespace
}  // namespace strongpoint
