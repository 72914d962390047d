// The parts of the iterative solver: block matrices, incomplete factors, BiCGSTAB.
#include "problems/core/block_ilut.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>
#include <omp.h>

#include "problems/core/bicgstab.hpp"
#include "tests/linear_systems.hpp"

namespace strongpoint {
namespace {

/// Factors are kept in single precision, some digits of which go in the elimination.
constexpr double single_precision = 1e-5;

std::vector<int> shuffled(int size, std::mt19937_64& generator) {
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  for (int i = size - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<int>(uniform01(generator) * (i + 1))]);
  }
  return order;
}

/// The entry of each unknown of `from`, in the order of nodes.
template <int Size>
Eigen::VectorXd reordered(const Eigen::VectorXd& from, const std::vector<int>& order) {
  Eigen::VectorXd to(from.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    to.segment<Size>(static_cast<int>(i) * Size) = from.segment<Size>(order[i] * Size);
  }
  return to;
}

template <int Size>
void check_product() {
  std::mt19937_64 generator(Size);
  const int nodes = 20;
  const Eigen::MatrixXd matrix = sparse_matrix(nodes * Size, nodes * Size, 0.1, generator);
  const Eigen::VectorXd x = random_vector(nodes * Size, generator);
  const std::vector<int> order = shuffled(nodes, generator);
  const BlockMatrix<Size> blocks = block_matrix<Size>(system_of(matrix, x, Size), order);
  Eigen::VectorXd product(x.size());
  blocks.multiply(reordered<Size>(x, order), product);
  const Eigen::VectorXd expected = reordered<Size>(matrix * x, order);
  EXPECT_LT((product - expected).lpNorm<Eigen::Infinity>(), 1e-14) << Size;
}

TEST(BlockMatrix, MultipliesAsTheSystemInAnyOrderAndBlockSize) {
  check_product<1>();
  check_product<2>();
  check_product<3>();
  check_product<4>();
}

TEST(BlockMatrix, MultipliesToTheSameBitsOnAnyNumberOfThreads) {
  std::mt19937_64 generator(5);
  const int nodes = 2000;  // enough for threads to share
  LinearSystem system;
  for (int row = 0; row < nodes; ++row) {
    for (int column = std::max(0, row - 3); column <= row; ++column) {
      system.columns.push_back(column);
      system.values.push_back(uniform01(generator));
    }
    system.offsets.push_back(static_cast<std::int64_t>(system.columns.size()));
  }
  const std::vector<int> order = shuffled(nodes, generator);
  const Eigen::VectorXd x = random_vector(nodes, generator);
  Eigen::VectorXd products[2] = {x, x};
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    block_matrix<1>(system, order).multiply(x, products[threads - 1]);
  }
  EXPECT_EQ(products[0], products[1]);
}

std::vector<int> as_is(int nodes) {
  std::vector<int> order(nodes);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

template <int Size>
void check_complete_factors() {
  std::mt19937_64 generator(10 + Size);
  const int nodes = 15;
  const Eigen::MatrixXd matrix = dominant_matrix(nodes * Size, 0.2, generator);
  const Eigen::VectorXd x = random_vector(nodes * Size, generator);
  const auto blocks = block_matrix<Size>(system_of(matrix, x, Size), as_is(nodes));
  const BlockIlut<Size> factors(blocks, {.drop = 0, .fill = 100});
  Eigen::VectorXd solved(x.size());
  factors.apply(matrix * x, solved);
  EXPECT_LT((solved - x).lpNorm<Eigen::Infinity>(), single_precision) << Size;
  EXPECT_EQ(factors.shifted_pivots(), 0);
}

TEST(BlockIlut, WithoutDroppingIsTheInverse) {
  check_complete_factors<1>();
  check_complete_factors<2>();
  check_complete_factors<3>();
  check_complete_factors<4>();
}

/// Keeps the `most` largest entries of a row within [begin, end) and zeroes the others.
void keep_largest(Eigen::MatrixXd& matrix, int row, int begin, int end, std::int64_t most) {
  std::vector<std::pair<double, int>> sizes;
  for (int j = begin; j < end; ++j) sizes.emplace_back(-std::abs(matrix(row, j)), j);
  std::sort(sizes.begin(), sizes.end());
  for (std::size_t i = most; i < sizes.size(); ++i) matrix(row, sizes[i].second) = 0;
}

/// Saad 2003, algorithm 10.6, on a dense matrix: L below the diagonal, U on and above it.
Eigen::MatrixXd dense_ilut(const Eigen::MatrixXd& a, double drop, double fill) {
  const auto n = static_cast<int>(a.rows());
  Eigen::MatrixXd f = a;
  for (int i = 0; i < n; ++i) {
    const auto left = (a.row(i).head(i).array() != 0).count();
    const auto right = (a.row(i).array() != 0).count() - left;
    const double least = drop * a.row(i).cwiseAbs().sum() / static_cast<double>(left + right);
    for (int k = 0; k < i; ++k) {
      f(i, k) /= f(k, k);
      if (std::abs(f(i, k)) <= least) f(i, k) = 0;
      f.row(i).tail(n - k - 1) -= f(i, k) * f.row(k).tail(n - k - 1);
    }
    for (int j = i + 1; j < n; ++j) {
      if (std::abs(f(i, j)) <= least) f(i, j) = 0;
    }
    keep_largest(f, i, 0, i, std::llround(std::ceil(fill * static_cast<double>(left))));
    keep_largest(f, i, i + 1, n, std::llround(std::ceil(fill * static_cast<double>(right))));
  }
  return f;
}

TEST(BlockIlut, DropsAsTheAlgorithmOnADenseMatrix) {
  std::mt19937_64 generator(21);
  const int n = 60;
  const Eigen::MatrixXd matrix = dominant_matrix(n, 0.1, generator);
  const Eigen::VectorXd r = random_vector(n, generator);
  for (const auto& [drop, fill] : {std::pair{0.1, 100.0}, {0.0, 1.0}, {0.3, 0.5}, {0.05, 2.0}}) {
    const Eigen::MatrixXd dense = dense_ilut(matrix, drop, fill);
    const Eigen::VectorXd expected = dense.triangularView<Eigen::Upper>().solve(
        dense.triangularView<Eigen::UnitLower>().solve(r));
    const BlockIlut<1> factors(block_matrix<1>(system_of(matrix, r), as_is(n)), {drop, fill});
    Eigen::VectorXd z(n);
    factors.apply(r, z);
    EXPECT_LT((z - expected).norm(), single_precision * expected.norm()) << drop << ' ' << fill;
    EXPECT_EQ(factors.blocks(), (dense.array() != 0).count() - n) << drop << ' ' << fill;
  }
}

TEST(BlockIlut, ShiftsAndCountsSingularPivots) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(4, 4);
  matrix.topLeftCorner(2, 2) << 0, 1, 1, 0;
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(4);
  const BlockIlut<1> single(block_matrix<1>(system_of(matrix, b), as_is(4)), {});
  EXPECT_EQ(single.shifted_pivots(), 1);
  // As a block the same rows need a pivot, not a shift.
  const BlockIlut<2> paired(block_matrix<2>(system_of(matrix, b, 2), as_is(2)), {});
  EXPECT_EQ(paired.shifted_pivots(), 0);
  EXPECT_NEAR(solve(system_of(matrix, b), "bicgstab").x[0], 1, 1e-8);
}

TEST(BlockIlut, NamesARowOfZeros) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(6, 6);
  matrix.row(2).setZero();
  matrix.row(3).setZero();
  const auto blocks = block_matrix<2>(system_of(matrix, Eigen::VectorXd::Ones(6), 2), as_is(3));
  EXPECT_NE(message_of<CaseError>([&] { BlockIlut<2>(blocks, {}); }).find("block row 1"),
            std::string::npos);
}

/// Leaves a vector as it is.
struct NoPreconditioner {
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const { z = r; }
};

/// A dense matrix as BiCGSTAB wants it.
struct DenseMatrix {
  Eigen::MatrixXd a;
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const { y.noalias() = a * x; }
};

TEST(Bicgstab, SolvesInAsManyIterationsAsThereAreUnknowns) {
  std::mt19937_64 generator(31);
  const DenseMatrix matrix{dominant_matrix(12, 1, generator)};
  const Eigen::VectorXd b = random_vector(12, generator);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(12);
  const auto report = Bicgstab(12, {.tolerance = 1e-12}).solve(matrix, NoPreconditioner{}, b, x);
  EXPECT_EQ(report.outcome, Bicgstab::Outcome::converged);
  EXPECT_LE(report.iterations, 13);  // in exact arithmetic 12
  EXPECT_LE((b - matrix.a * x).norm(), 1e-12 * b.norm());
  EXPECT_LE(report.residual, 1e-12);
}

TEST(Bicgstab, GivesZeroForZeroAndStopsAtOnceAtASolution) {
  const DenseMatrix matrix{Eigen::MatrixXd::Identity(3, 3) * 2};
  Eigen::VectorXd x = Eigen::VectorXd::Ones(3);
  EXPECT_EQ(Bicgstab(3, {}).solve(matrix, NoPreconditioner{}, Eigen::VectorXd::Zero(3), x).residual,
            0);
  EXPECT_EQ(x, Eigen::VectorXd::Zero(3));
  x.setConstant(0.5);
  EXPECT_EQ(
      Bicgstab(3, {}).solve(matrix, NoPreconditioner{}, Eigen::VectorXd::Ones(3), x).iterations, 0);
}

TEST(Bicgstab, ReportsABreakdownAndAnExhaustedLimit) {
  DenseMatrix matrix{Eigen::MatrixXd::Zero(2, 2)};
  matrix.a << 0, 1, -1, 0;  // r . A r = 0 for every r
  const Eigen::VectorXd b = Eigen::VectorXd::Unit(2, 0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
  const auto broken = Bicgstab(2, {}).solve(matrix, NoPreconditioner{}, b, x);
  EXPECT_EQ(broken.outcome, Bicgstab::Outcome::breakdown);
  EXPECT_DOUBLE_EQ(broken.residual, 1);
  std::mt19937_64 generator(32);
  const DenseMatrix large{dominant_matrix(40, 1, generator)};
  x.setZero(40);
  const auto stopped = Bicgstab(40, {.iterations = 2})
                           .solve(large, NoPreconditioner{}, random_vector(40, generator), x);
  EXPECT_EQ(stopped.outcome, Bicgstab::Outcome::iterations_exhausted);
  EXPECT_EQ(stopped.iterations, 2);
}

}  // namespace
}  // namespace strongpoint
