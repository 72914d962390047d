// Rigid aggregates of multigrid, and the weights that make forces of rows.
#include "problems/core/transfer.hpp"

#include <array>

#include <gtest/gtest.h>

#include "problems/core/balance.hpp"
#include "problems/core/block_amg.hpp"
#include "tests/linear_systems.hpp"

namespace strongpoint {
namespace {

constexpr double round_off = 1e-12;
constexpr double single_precision = 1e-6;

/// A row of two fields' system by its coefficients of one field at nodes.
void add_row(LinearSystem& system, int field, const std::vector<int>& nodes,
             const std::vector<double>& numbers, double scale) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    system.columns.push_back(2 * nodes[i] + field);
    system.values.push_back(numbers[i] * scale);
  }
  system.offsets.push_back(static_cast<std::int64_t>(system.columns.size()));
  system.row_scales.push_back(scale);
}

/// Two Laplace equations on a square of 4^2 nodes: values on the left, outward normal derivatives
/// on the other sides by three nodes; rows scaled at random.
LinearSystem laplace_pair(double h) {
  constexpr int n = 4;
  LinearSystem system;
  system.places.resize(2, n * n);
  for (int node = 0; node < n * n; ++node) {
    const int i = node / n;
    const int j = node % n;
    system.places.col(node) = h * Eigen::Vector2d(i, j);
    for (int field = 0; field < 2; ++field) {
      const double scale = 0.3 + 0.1 * (node % 3) + 0.2 * field;
      if (i == 0) {
        add_row(system, field, {node}, {1}, scale);
      } else if (i == n - 1) {
        add_row(system, field, {node - 2 * n, node - n, node}, {0.5 / h, -2 / h, 1.5 / h}, scale);
      } else if (j == 0) {
        add_row(system, field, {node, node + 1, node + 2}, {1.5 / h, -2 / h, 0.5 / h}, scale);
      } else if (j == n - 1) {
        add_row(system, field, {node - 2, node - 1, node}, {0.5 / h, -2 / h, 1.5 / h}, scale);
      } else {
        const double a = 1 / (h * h);
        add_row(system, field, {node - n, node - 1, node, node + 1, node + n}, {a, a, -4 * a, a, a},
                scale);
      }
    }
  }
  system.fields = 2;
  system.dimension = 2;
  return system;
}

TEST(BalanceWeights, AreAreasInsideAndLengthsOfTheOtherSignOnSides) {
  const double h = 0.1;
  const LinearSystem system = laplace_pair(h);
  const Balance balance = balance_of(system);
  const Eigen::VectorXd& weights = balance.weights;
  // Side rows know nodes at h and 2 h only, the mean of which is h sqrt 2.
  const double inside = h * h;
  const double side = -h * std::sqrt(2.0);
  for (int node : {5, 6, 9, 10}) {
    for (int row : {2 * node, 2 * node + 1}) {
      EXPECT_NEAR(weights[row] * system.row_scales[row], inside, round_off) << row;
    }
  }
  for (int row : {2 * 4, 2 * 8 + 1, 2 * 13, 2 * 14 + 1, 2 * 11}) {
    EXPECT_NEAR(weights[row] * system.row_scales[row], side, round_off) << row;
  }
  // Diagonals: -4 of four nodes inside, -1.5 sqrt 2 of eight on sides; those of values are as
  // large.
  const double mean = (4 * -4 + 8 * 1.5 * -std::sqrt(2.0)) / 12;
  for (int row : {0, 1, 4}) EXPECT_NEAR(weights[row] * system.row_scales[row], mean, round_off);
  for (int node : {0, 3, 5, 10}) EXPECT_EQ(balance.has_traction[node], 0) << node;
  for (int node : {4, 7, 11, 12, 15}) EXPECT_EQ(balance.has_traction[node], 1) << node;
}

TEST(RigidTransfer, FollowsEveryRigidMotionOverTwoLevelsAndSumsForcesAndMoments) {
  const int nodes = 12;
  PlaneBodies bodies{Eigen::Matrix2Xd(2, nodes), Eigen::VectorXd::Zero(nodes)};
  for (int i = 0; i < nodes; ++i) {
    const int row = i / 4;
    bodies.places.col(i) << 0.3 * (i - 4 * row), 0.2 * row + 0.01 * i;
  }
  const PlaneBodies fine = bodies;
  const Aggregates first{{0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3}, 4};
  const Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(2 * nodes, 1, 2);
  const Transfer<2, 3> down = rigid_transfer(first, bodies, weights);
  const PlaneBodies middle = bodies;
  const Transfer<3, 3> further = rigid_transfer({{0, 0, 1, 1}, 2}, bodies);
  const auto motion = [](const Eigen::Vector2d& place) -> Eigen::Vector2d {
    return {1 - 0.7 * place[1], -2 + 0.7 * place[0]};
  };
  const auto body_motion = [&](const PlaneBodies& of, int i) {
    Eigen::Vector3f result;
    result << motion(of.places.col(i)).cast<float>(), static_cast<float>(0.7 * of.radii[i]);
    return result;
  };
  for (int i = 0; i < nodes; ++i) {
    const Eigen::Map<const Eigen::Matrix<float, 2, 3>> block(down.down.data() + 6 * i);
    const Eigen::Vector2f moved = block * body_motion(middle, first.of_node[i]);
    EXPECT_LT((moved.cast<double>() - motion(fine.places.col(i))).norm(), single_precision) << i;
    const Eigen::Map<const Eigen::Matrix<float, 3, 2>> up(down.up.data() + 6 * i);
    const Eigen::Vector2f weight = weights.segment<2>(2 * i).cast<float>();
    EXPECT_LT((up - block.transpose() * weight.asDiagonal()).norm(), single_precision) << i;
  }
  for (int i = 0; i < 4; ++i) {
    const Eigen::Map<const Eigen::Matrix3f> block(further.down.data() + 9 * i);
    EXPECT_LT((block * body_motion(bodies, i / 2) - body_motion(middle, i)).norm(),
              single_precision);
  }
}

/// The turn of a lone node is no unknown; a 1 on the diagonal keeps the coarse matrix regular.
TEST(RigidTransfer, LeavesTheTurnOfALoneNodeToItself) {
  const LinearSystem system = laplace_pair(0.1);
  std::vector<int> order(16);
  for (int i = 0; i < 16; ++i) order[i] = i;
  PlaneBodies bodies{system.places, Eigen::VectorXd::Zero(16)};
  Aggregates aggregates{std::vector<int>(16, 0), 2};
  aggregates.of_node[10] = 1;
  const BlockMatrix<2> matrix = block_matrix<2>(system, order);
  const CoarseLevel<2, 3> coarse =
      coarsen(matrix, rigid_transfer(aggregates, bodies, balance_of(system).weights));
  ASSERT_EQ(coarse.matrix.columns, (std::vector<int>{0, 1, 0, 1}));
  const Eigen::Map<const Eigen::Matrix3d> last(coarse.matrix.values.data() + 27);
  EXPECT_EQ(last(2, 2), 1);
  EXPECT_EQ(last.row(2).head(2).norm() + last.col(2).head(2).norm(), 0);
  EXPECT_EQ(bodies.radii[1], 0);
}

/// The blocks (Rows, Columns) of a way between levels, one a node; a node's rows and its
/// aggregate's columns.
template <int Rows, int Columns>
Eigen::MatrixXd dense_down(const Aggregates& aggregates, const std::vector<float>& blocks) {
  const auto nodes = static_cast<Eigen::Index>(aggregates.of_node.size());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(nodes * Rows, aggregates.count * Columns);
  for (Eigen::Index node = 0; node < nodes; ++node) {
    if (aggregates.of_node[node] < 0) continue;
    dense.block<Rows, Columns>(node * Rows, aggregates.of_node[node] * Columns) =
        Eigen::Map<const Eigen::Matrix<float, Rows, Columns>>(blocks.data() + node * Rows * Columns)
            .template cast<double>();
  }
  return dense;
}

template <int Size>
Eigen::MatrixXd dense_of(const BlockMatrix<Size>& matrix) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.rows() * Size, matrix.rows() * Size);
  for (int row = 0; row < matrix.rows(); ++row) {
    for (std::int64_t i = matrix.offsets[row]; i < matrix.offsets[row + 1]; ++i) {
      dense.block<Size, Size>(row * Size, matrix.columns[i] * Size) =
          Eigen::Map<const Eigen::Matrix<double, Size, Size>>(matrix.values.data() +
                                                              i * Size * Size);
    }
  }
  return dense;
}

/// Restricts, prolongs and smooths on a level and compares with products of dense matrices.
template <int Size, int Coarse>
void expect_dense_products(const BlockMatrix<Size>& matrix,
                           const Transfer<Size, Coarse>& transfer) {
  const Eigen::MatrixXd a = dense_of(matrix);
  const Eigen::MatrixXd p = dense_down<Size, Coarse>(transfer.aggregates, transfer.down);
  Eigen::MatrixXd r(p.cols(), p.rows());
  r.setZero();
  for (std::size_t node = 0; node < transfer.aggregates.of_node.size(); ++node) {
    const int aggregate = transfer.aggregates.of_node[node];
    if (aggregate < 0) continue;
    r.block<Coarse, Size>(aggregate * Coarse, static_cast<Eigen::Index>(node) * Size) =
        Eigen::Map<const Eigen::Matrix<float, Coarse, Size>>(transfer.up.data() +
                                                             node * Coarse * Size)
            .template cast<double>();
  }
  const AmgLevel<Size, Coarse> level(matrix, transfer, coarsen(matrix, transfer).fine_to_coarse);
  std::mt19937_64 generator(1);
  const Eigen::VectorXf given =
      random_vector(static_cast<int>(a.rows()), generator).template cast<float>();
  const Eigen::VectorXd summed = r * given.template cast<double>();
  EXPECT_LT((level.restrict_to_coarse(given).template cast<double>() - summed).norm(),
            single_precision * r.norm());

  level.correction() = random_vector(static_cast<int>(p.cols()), generator).template cast<float>();
  const Eigen::VectorXd correction = level.correction().template cast<double>();
  const Eigen::VectorXd left = given.template cast<double>() - a * p * correction;
  Eigen::VectorXf smoothed = left.cast<float>();
  block_ilu0(matrix).apply(smoothed, smoothed);
  const Eigen::VectorXd wanted = p * correction + smoothed.template cast<double>();
  Eigen::VectorXf z(given.size());
  level.smooth(given, z);
  EXPECT_LT((z.template cast<double>() - wanted).norm(), 10 * single_precision * wanted.norm());
}

TEST(AmgLevel, RestrictsAndProlongsAsDenseMatricesDo) {
  const LinearSystem system = laplace_pair(0.5);
  std::vector<int> order(16);
  for (int i = 0; i < 16; ++i) order[i] = i;
  const BlockMatrix<2> matrix = block_matrix<2>(system, order);
  // One node outside, one alone, a pair and larger ones.
  const Aggregates first{{-1, 0, 0, 1, 2, 3, 3, 1, 2, 4, 3, 1, 2, 4, 4, 5}, 6};
  expect_dense_products<2, 2>(matrix, constant_transfer(matrix, first));
  PlaneBodies bodies{system.places, Eigen::VectorXd::Zero(16)};
  const Transfer<2, 3> rigid = rigid_transfer(first, bodies, balance_of(system).weights);
  expect_dense_products<2, 3>(matrix, rigid);
  const BlockMatrix<3> coarse = coarsen(matrix, rigid).matrix;
  expect_dense_products<3, 3>(coarse, rigid_transfer({{0, 0, 1, 1, -1, 1}, 2}, bodies));
}

}  // namespace
}  // namespace strongpoint
