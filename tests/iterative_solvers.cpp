// The iterative solvers with every preconditioner, their parts, and the choice between solvers.
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <omp.h>

#include "bench/elastic_system.hpp"
#include "problems/core/block_amg.hpp"
#include "problems/core/node_ordering.hpp"
#include "studies/support/run_case.hpp"
#include "tests/linear_systems.hpp"

namespace strongpoint {
namespace {

/// What a tolerance of 1e-9 on the residual leaves in the solution of a well conditioned system.
constexpr double iterative_error = 1e-7;
/// Factors are kept in single precision, some digits of which go in the elimination.
constexpr double single_precision = 1e-5;

const std::vector<std::string> iterations{"bicgstab", "gmres", "idr"};
const std::vector<std::string> preconditioners{"ilut", "ilu0", "amg"};

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

/// Laplace's equation by differences on n^2 nodes; rows on the rim are fixed.
LinearSystem laplace_2d(int n) {
  LinearSystem system;
  system.dimension = 2;
  for (int node = 0; node < n * n; ++node) {
    const int i = node / n;
    const int j = node % n;
    const bool is_rim = i == 0 || j == 0 || i == n - 1 || j == n - 1;
    for (const int other : {node - n, node - 1, node, node + 1, node + n}) {
      if (is_rim && other != node) continue;
      system.columns.push_back(other);
      system.values.push_back(other == node ? 1 : -0.25);
    }
    system.offsets.push_back(static_cast<std::int64_t>(system.columns.size()));
  }
  std::mt19937_64 generator(1);
  system.right_hand_side = random_vector(n * n, generator);
  return system;
}

/// x_(i+1) = b_i around a circle: no diagonal, and no Krylov space smaller than all helps.
LinearSystem shift(int n) {
  LinearSystem system;
  system.dimension = 2;
  for (int row = 0; row < n; ++row) {
    system.columns.push_back((row + 1) % n);
    system.values.push_back(1);
    system.offsets.push_back(row + 1);
  }
  system.right_hand_side = Eigen::VectorXd::LinSpaced(n, 1, 2);
  return system;
}

TEST(IterativeSolvers, AgreeWithUmfpackOnRandomSystemsOfEveryBlockSize) {
  std::mt19937_64 generator(2);
  for (int fields = 1; fields <= 4; ++fields) {
    const int size = 60 * fields;
    const Eigen::MatrixXd matrix = dominant_matrix(size, 0.05, generator);
    const LinearSystem system = system_of(matrix, random_vector(size, generator), fields);
    const Eigen::VectorXd direct = solve(system, "umfpack").x;
    for (const std::string& iteration : iterations) {
      for (const std::string& preconditioner : preconditioners) {
        const std::string spec = fmt::format("{}[precond={}]", iteration, preconditioner);
        const LinearSolution solution = solve(system, spec);
        EXPECT_LT(difference(solution.x, direct), iterative_error) << spec << fields;
        EXPECT_GT(solution.iterations, 0);
        EXPECT_GT(solution.bytes, 0U);
      }
    }
  }
}

TEST(IterativeSolvers, SolveElasticityWithTractionsAndGhostsToTheSameBitsOnTwoThreads) {
  // A residual of 1e-9 times the condition of a plane of 21^2 nodes.
  constexpr double elastic_error = 1e-6;
  const KnownSystem plane = ElasticSystem<2>({.level = 21, .stencil = "nearest[k=15]"}).assembled();
  const KnownSystem space = ElasticSystem<3>({.level = 7}).assembled();
  for (const std::string spec : {"bicgstab[precond=amg]", "idr[precond=amg]", "gmres[precond=ilu0]",
                                 "idr", "bicgstab[precond=ilu0]", "auto", "mumps"}) {
    for (const KnownSystem& known : {plane, space}) {
      omp_set_num_threads(1);
      const LinearSolution one = solve(known.system, spec);
      omp_set_num_threads(2);
      const LinearSolution two = solve(known.system, spec);
      omp_set_num_threads(1);
      EXPECT_LT(difference(one.x, known.solution), elastic_error) << spec;
      EXPECT_EQ(one.x, two.x) << spec;
      EXPECT_EQ(one.iterations, two.iterations) << spec;
    }
  }
}

TEST(BlockFactors, InTheFullPatternAreTheInverse) {
  std::mt19937_64 generator(3);
  const Eigen::MatrixXd matrix = dominant_matrix(30, 1, generator);
  const Eigen::VectorXd x = random_vector(30, generator);
  std::vector<int> order(10);
  for (int i = 0; i < 10; ++i) order[i] = i;
  const auto factors = block_ilu0(block_matrix<3>(system_of(matrix, x, 3), order));
  Eigen::VectorXf solved = (matrix * x).cast<float>();
  factors.apply(solved, solved);
  EXPECT_LT((solved.cast<double>() - x).lpNorm<Eigen::Infinity>(), single_precision);
}

/// Four nodes around a circle: the second and the last, which are no neighbours, meet when the
/// first is eliminated, and nothing is dropped once both rows are filled.
TEST(BlockFactors, WithFillInTheRowsThatMeetAreTheInverse) {
  std::mt19937_64 generator(6);
  Eigen::MatrixXd matrix = dominant_matrix(8, 1, generator);
  for (int i = 0; i < 2; ++i) {
    const int j = i + 2;  // opposite nodes
    matrix.block<2, 2>(2 * i, 2 * j).setZero();
    matrix.block<2, 2>(2 * j, 2 * i).setZero();
  }
  const Eigen::VectorXd x = random_vector(8, generator);
  const BlockMatrix<2> blocks = block_matrix<2>(system_of(matrix, x, 2), {0, 1, 2, 3});
  const auto error = [&](const std::vector<char>& filled) {
    Eigen::VectorXf solved = (matrix * x).cast<float>();
    block_ilu0(blocks, filled).apply(solved, solved);
    return (solved.cast<double>() - x).lpNorm<Eigen::Infinity>();
  };
  EXPECT_LT(error({0, 1, 0, 1}), single_precision);
  EXPECT_GT(error({0, 0, 0, 1}), 100 * single_precision);
  EXPECT_EQ(error({0, 0, 0, 0}), error({}));
}

/// The entries of a block matrix.
template <int Size>
Eigen::MatrixXd dense(const std::vector<std::int64_t>& offsets, const std::vector<int>& columns,
                      const auto& values, int width) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero((offsets.size() - 1) * Size, width * Size);
  for (std::size_t row = 0; row + 1 < offsets.size(); ++row) {
    for (std::int64_t i = offsets[row]; i < offsets[row + 1]; ++i) {
      for (int e = 0; e < Size * Size; ++e) {
        matrix(row * Size + e % Size, columns[i] * Size + e / Size) = values[i * Size * Size + e];
      }
    }
  }
  return matrix;
}

TEST(Aggregation, CoversWhatIsCoupledAndCoarsensToTheGalerkinProduct) {
  const int n = 12;
  const LinearSystem system = laplace_2d(n);
  std::vector<int> order(n * n);
  for (int i = 0; i < n * n; ++i) order[i] = i;
  const BlockMatrix<1> matrix = block_matrix<1>(system, order);
  const Aggregates aggregates = aggregate(matrix, StrongCouplings{});
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(n * n, aggregates.count);
  for (int node = 0; node < n * n; ++node) {
    const bool is_rim = system.offsets[node + 1] - system.offsets[node] == 1;
    EXPECT_EQ(aggregates.of_node[node] < 0, is_rim) << node;
    if (!is_rim) p(node, aggregates.of_node[node]) = 1;
  }
  for (int i = 0; i < aggregates.count; ++i) EXPECT_GT(p.col(i).sum(), 0);
  EXPECT_LT(aggregates.count, n * n / 3);
  const auto coarse = coarsen(matrix, constant_transfer(matrix, aggregates));
  const Eigen::MatrixXd a = dense<1>(matrix.offsets, matrix.columns, matrix.values, n * n);
  const Eigen::MatrixXd ap = dense<1>(coarse.fine_to_coarse.offsets, coarse.fine_to_coarse.columns,
                                      coarse.fine_to_coarse.values, aggregates.count);
  const Eigen::MatrixXd galerkin = dense<1>(coarse.matrix.offsets, coarse.matrix.columns,
                                            coarse.matrix.values, aggregates.count);
  EXPECT_LT((ap - a * p).norm(), 1e-6);                         // single precision
  EXPECT_LT((galerkin - p.transpose() * a * p).norm(), 1e-12);  // the diagonal of A is 1
}

TEST(BlockAmg, TakesFewIterationsOnAnyNumberOfNodes) {
  // 9 and 11 were measured; ILUT takes 16 and 61, ILU(0) 43 and 167.
  const int coarse = solve(laplace_2d(60), "bicgstab[precond=amg]").iterations;
  const int fine = solve(laplace_2d(240), "bicgstab[precond=amg]").iterations;
  EXPECT_LT(coarse, 16);
  EXPECT_LT(fine, 22);
}

/// Aggregates of strong inward couplings alone let this stall at a residual of 1e-1.
TEST(BlockAmg, SolvesPlatesUnderTractionsOnAllSides) {
  for (const char* cloud : {"grid", "perturbed"}) {
    const auto error = [&](const char* solver) {
      const CaseKey key{"plate_hole", "lsfdm", "nearest[k=15]", cloud, "collocation", solver, 161};
      return run_steady_case(key, RunOptions{}).quantities[0].value.value();
    };
    const double direct = error("umfpack");
    EXPECT_NEAR(error("bicgstab[precond=amg,tolerance=1e-10,iterations=80]"), direct, 1e-5 * direct)
        << cloud;
  }
}

/// Coarse bodies that do not turn, or rows that are not summed as forces, need 150 iterations and
/// more where the membrane bends; without fill in the rows of tractions the substitution of `mfpm`
/// grows along the loaded side until nothing converges. 23 and 33, for
/// `mfpm_original` 23 and 31 were measured, and 37 and 29 at twice the resolution.
TEST(BlockAmg, SolvesCooksMembraneInIterationsThatHardlyGrow) {
  for (const char* method : {"mfpm", "mfpm_original"}) {
    const auto corner = [&](int level, const char* solver) {
      const CaseKey key{"cook", method, "block", "grid", "collocation", solver, level};
      return run_steady_case(key, RunOptions{}).quantities[0].value.value();
    };
    for (const int level : {81, 161}) {
      const double direct = corner(level, "umfpack");
      EXPECT_NEAR(corner(level, "bicgstab[precond=amg,tolerance=1e-10,iterations=60]"), direct,
                  1e-6 * direct)
          << method << level;
    }
  }
}

TEST(NodeOrdering, ListsTheUnknownsOfEveryNodeTogetherAndOnce) {
  const KnownSystem known = ElasticSystem<2>({.level = 11, .stencil = "nearest[k=15]"}).assembled();
  const LinearSystem& system = known.system;
  const Eigen::Map<const RowMatrix> matrix(
      system.rows(), system.rows(), static_cast<Eigen::Index>(system.values.size()),
      system.offsets.data(), system.columns.data(), system.values.data());
  const std::vector<std::int64_t> order = node_ordering(matrix, 2);
  ASSERT_EQ(static_cast<std::int64_t>(order.size()), system.rows());
  EXPECT_EQ(std::set<std::int64_t>(order.begin(), order.end()).size(), order.size());
  for (std::size_t i = 0; i < order.size(); i += 2) EXPECT_EQ(order[i] + 1, order[i + 1]);
  EXPECT_TRUE(node_ordering(matrix, static_cast<int>(system.rows()) - 1).empty());
}

TEST(Umfpack, SolvesInEveryOrderingAndWhereTheDiagonalIsSmall) {
  const KnownSystem known = ElasticSystem<2>({.level = 21, .stencil = "nearest[k=15]"}).assembled();
  for (const char* spec : {"umfpack[ordering=usual]", "umfpack[ordering=metis]", "umfpack"}) {
    EXPECT_LT(difference(solve(known.system, spec).x, known.solution), 1e-10) << spec;
  }
  // Pivots on the diagonal leave 4e-15 here, full pivoting 7e-16; refinement brings both down.
  const int n = 60;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n) * 1e-2;
  matrix.diagonal(1).setOnes();
  matrix.diagonal(-1).setConstant(-0.9);
  matrix.diagonal(2).setConstant(0.7);
  std::mt19937_64 generator(4);
  const Eigen::VectorXd x = random_vector(n, generator);
  const LinearSolution solution = solve(system_of(matrix, matrix * x), "umfpack[ordering=metis]");
  EXPECT_LT(solution.residual, 1e-14);
}

TEST(Auto, ChoosesByDimensionSizeAndKind) {
  EXPECT_EQ(solve(laplace_2d(20), "auto").solver, "frontal");
  const LinearSystem large = laplace_2d(140);
  const LinearSolution solution = solve(large, "auto");
  EXPECT_EQ(solution.solver, "bicgstab[precond=amg,tolerance=1e-10,iterations=80]");
  EXPECT_LT(difference(solution.x, solve(large, "umfpack").x), iterative_error);
  EXPECT_EQ(solve(ElasticSystem<3>({.level = 13}).assembled().system, "auto").solver,
            "bicgstab[precond=ilu0,tolerance=1e-10,iterations=200]");
  std::mt19937_64 generator(5);
  const Eigen::MatrixXd matrix = sparse_matrix(30, 20, 0.5, generator);
  EXPECT_EQ(solve(system_of(matrix, random_vector(30, generator)), "auto").solver, "normal");
}

TEST(Auto, SolvesDirectlyWhatAnIterationFailsOn) {
  const LinearSystem system = shift(16000);
  EXPECT_NE(message_of<CaseError>([&] { solve(system, "bicgstab[precond=amg,iterations=150]"); }),
            "");
  const LinearSolution solution = solve(system, "auto");
  EXPECT_EQ(solution.solver, "mumps");
  EXPECT_LT(solution.residual, 1e-14);
}

/// The error against the exact solution, which a residual says nothing of, at two levels.
TEST(Bicgstab, ConvergesUnderRefinementWithTractionsOnOneAndThreeFaces) {
  for (const char* faces : {"one", "three"}) {
    const auto error = [&](int level) {
      const CaseKey key{std::string("elastic_cube[traction=") + faces + "]",
                        "lsfdm[weight=power[p=4]]",
                        "nearest[k=35]",
                        "perturbed",
                        "collocation[boundary=ghost]",
                        "bicgstab",
                        level};
      return run_steady_case(key, RunOptions{}).quantities[0].value.value();
    };
    const double coarse = error(7);
    const double fine = error(13);
    EXPECT_LT(fine, 0.4 * coarse) << faces;  // second order at twice the resolution: 0.25
  }
}

}  // namespace
}  // namespace strongpoint
