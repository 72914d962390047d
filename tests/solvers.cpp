// Solvers of square systems against each other, and what they refuse.
#include "problems/core/solvers.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "bench/elastic_system.hpp"
#include "problems/core/sparse_factor.hpp"
#include "tests/linear_systems.hpp"

namespace strongpoint {
namespace {

/// What BiCGSTAB's default tolerance on the residual, 1e-9, leaves in the solution of a well
/// conditioned system.
constexpr double iterative_error = 1e-7;

void has(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << "'" << message << "' lacks '" << part << "'";
}

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

/// The differences of Laplace's equation on n^3 nodes, with a drift along x that makes them
/// unsymmetric.
LinearSystem laplace_3d(int n) {
  LinearSystem system;
  const auto add = [&](int i, int j, int k, double value) {
    if (std::min({i, j, k}) < 0 || std::max({i, j, k}) >= n) return;
    system.columns.push_back((i * n + j) * n + k);
    system.values.push_back(value);
  };
  for (int node = 0; node < n * n * n; ++node) {
    const int i = node / (n * n);
    const int j = node / n % n;
    const int k = node % n;
    add(i - 1, j, k, -0.2);
    add(i, j - 1, k, -1. / 6);
    add(i, j, k - 1, -1. / 6);
    add(i, j, k, 1);
    add(i, j, k + 1, -1. / 6);
    add(i, j + 1, k, -1. / 6);
    add(i + 1, j, k, -0.13);
    system.offsets.push_back(static_cast<std::int64_t>(system.columns.size()));
  }
  std::mt19937_64 generator(1);
  system.right_hand_side = random_vector(n * n * n, generator);
  return system;
}

TEST(Bicgstab, AgreesWithUmfpackOnRandomSystemsOfEveryBlockSize) {
  std::mt19937_64 generator(2);
  for (int fields = 1; fields <= 4; ++fields) {
    const int size = 60 * fields;
    const Eigen::MatrixXd matrix = dominant_matrix(size, 0.05, generator);
    const LinearSystem system = system_of(matrix, random_vector(size, generator), fields);
    const LinearSolution solution = solve(system, "bicgstab");
    EXPECT_LT(difference(solution.x, solve(system, "umfpack").x), iterative_error) << fields;
    EXPECT_GT(solution.iterations, 0);
  }
}

TEST(Bicgstab, AgreesWithUmfpackOnPoissonInThreeDimensions) {
  const LinearSystem system = laplace_3d(16);
  const LinearSolution direct = solve(system, "umfpack");
  const LinearSolution solution = solve(system, "bicgstab");
  EXPECT_LT(difference(solution.x, direct.x), iterative_error);
  EXPECT_LT(solution.iterations, 20);
  EXPECT_EQ(direct.iterations, 0);
}

template <int Dim>
void check_elasticity(int level) {
  const KnownSystem known = ElasticSystem<Dim>({.level = level}).assembled();
  EXPECT_EQ(known.system.fields, Dim);
  const LinearSolution solution = solve(known.system, "bicgstab");
  EXPECT_LT(difference(solution.x, known.solution), iterative_error) << Dim;
  EXPECT_LT(difference(solve(known.system, "umfpack").x, known.solution), 1e-10) << Dim;
  // Far below the 80 that the largest cases may take.
  EXPECT_LT(solution.iterations, 30) << Dim;
}

TEST(Bicgstab, SolvesElasticityWithTractionsAndGhosts) {
  check_elasticity<2>(21);
  check_elasticity<3>(9);
}

TEST(Bicgstab, GivesTheSameSolutionInAnyOrder) {
  KnownSystem known = ElasticSystem<3>({.level = 7}).assembled();
  std::vector<int>& order = known.system.order;
  const int along_x = solve(known.system, "bicgstab").iterations;
  order.clear();
  EXPECT_LT(difference(solve(known.system, "bicgstab").x, known.solution), iterative_error);
  std::mt19937_64 generator(4);
  order = order_along(random_vector(static_cast<int>(known.solution.size()) / 3, generator));
  const LinearSolution shuffled = solve(known.system, "bicgstab");
  EXPECT_LT(difference(shuffled.x, known.solution), iterative_error);
  EXPECT_LE(along_x, shuffled.iterations);
}

TEST(Bicgstab, GivesTheSameBitsOnAnyNumberOfThreads) {
  const LinearSystem system = laplace_3d(12);
  omp_set_num_threads(1);
  const LinearSolution one = solve(system, "bicgstab");
  omp_set_num_threads(2);
  const LinearSolution two = solve(system, "bicgstab");
  EXPECT_EQ(one.x, two.x);
  EXPECT_EQ(one.iterations, two.iterations);
}

TEST(Bicgstab, TakesFewerIterationsWhenItDropsLess) {
  const LinearSystem system = laplace_3d(12);
  const int few = solve(system, "bicgstab[drop=1e-4,fill=10]").iterations;
  const int many = solve(system, "bicgstab[drop=0.2,fill=1]").iterations;
  EXPECT_LT(few, many);
}

TEST(Bicgstab, SaysWhyItFailedAndWhatToDo) {
  const std::string limit =
      message_of<CaseError>([] { solve(laplace_3d(12), "bicgstab[drop=1,fill=0,iterations=2]"); });
  for (const char* part : {"bicgstab", "2 iterations", "residual", "drop=", "fill=", "umfpack"}) {
    has(limit, part);
  }
  // The middle equation contradicts the first.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(3, 3);
  matrix.row(1) = matrix.row(0);
  const std::string singular = message_of<CaseError>(
      [&] { solve(system_of(matrix, Eigen::Vector3d(1, 2, 3)), "bicgstab"); });
  has(singular, "bicgstab");
  has(singular, "1 singular pivot blocks were shifted");
}

TEST(Bicgstab, RefusesSystemsAndOrdersThatDoNotFit) {
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(10, 10);
  const Eigen::VectorXd right = Eigen::VectorXd::Ones(10);
  const auto message = [](const LinearSystem& system) {
    return message_of<CaseError>([&] { solve(system, "bicgstab"); });
  };
  has(message(system_of(matrix, right, 3)), "10 unknowns are not 3 at every node");
  has(message(system_of(matrix, right, 5)), "takes 1 to 4");
  LinearSystem system = system_of(matrix, right, 2);
  system.order = {0, 1, 2, 3, 3};
  has(message(system), "node 3");
  system.order = {0, 1, 2, 3, 5};
  has(message(system), "node 5");
  system.order = {0, 1, 2};
  has(message(system), "3 of 5 nodes");
  system.order = {4, 3, 2, 1, 0};
  EXPECT_EQ(message(system), "");
}

TEST(Solvers, CheckTheirOptionsWhenTheSpecIsRead) {
  EXPECT_EQ(canonical_solver("bicgstab[fill=2,drop=1e-3]"), "bicgstab[drop=1e-3]");
  EXPECT_EQ(canonical_solver("bicgstab[drop=1e-2]"), "bicgstab");
  has(message_of<UsageError>([] { canonical_solver("bicgstab[drop=-1]"); }), "drop=-1");
  has(message_of<UsageError>([] { canonical_solver("bicgstab[iterations=0]"); }), "iterations=0");
  has(message_of<UsageError>([] { canonical_solver("bicgstab[tolerance=1]"); }), "tolerance=1");
  has(message_of<UsageError>([] { canonical_solver("bicgstab[fil=2]"); }),
      "precond, drop, fill, tolerance");
  has(message_of<UsageError>([] { canonical_solver("umfpack[fill=2]"); }), "ordering");
  EXPECT_TRUE(is_iterative("bicgstab[fill=3]"));
  EXPECT_FALSE(is_iterative("umfpack"));
}

TEST(Solvers, RefuseAResidualThatIsTooLarge) {
  // A tolerance that BiCGSTAB meets, but that is not enough.
  const std::string message =
      message_of<CaseError>([] { solve(laplace_3d(12), "bicgstab[tolerance=1e-2]"); });
  has(message, "bicgstab");
  has(message, "exceeds 1e-08");
}

TEST(OrderAlong, SortsACoordinateWithTiesByIndex) {
  Eigen::VectorXd x(5);
  x << 0.5, -1, 0.5, 2, -1;
  EXPECT_EQ(order_along(x), (std::vector<int>{1, 4, 0, 2, 3}));
}

/// Rows of very different size, so that UMFPACK scales them, without symmetry.
TEST(TriangularFactors, SolveAsUmfpackDoes) {
  std::mt19937_64 generator(11);
  for (const int n : {1, 2, 7, 60, 200}) {
    Eigen::MatrixXd dense = sparse_matrix(n, n, 0.1, generator);
    for (int i = 0; i < n; ++i) {
      dense(i, (i * 3 + 1) % n) += 2;  // no row is empty
      dense(i, i) += 3;
      dense.row(i) *= std::pow(10.0, i % 7 - 3);
    }
    RowMatrix matrix = dense.sparseView();
    matrix.makeCompressed();
    for (const auto ordering :
         {SparseFactor::Ordering::usual, SparseFactor::Ordering::least_fill}) {
      TriangularFactors factors = [&] {
        const SparseFactor factor(
            Eigen::Map<const RowMatrix>(n, n, matrix.nonZeros(), matrix.outerIndexPtr(),
                                        matrix.innerIndexPtr(), matrix.valuePtr()),
            ordering);
        return factor.packed();
      }();
      const Eigen::VectorXd x = random_vector(n, generator);
      const Eigen::VectorXd b = dense * x;
      Eigen::VectorXd found(n);
      factors.solve(b.data(), found.data());
      EXPECT_LT((found - x).lpNorm<Eigen::Infinity>(), 1e-10) << n;
      EXPECT_GE(factors.bytes(), n * sizeof(double));
    }
  }
}

}  // namespace
}  // namespace strongpoint
