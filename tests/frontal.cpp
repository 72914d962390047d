// The frontal solver: the graph of nodes, their order, the factors, and what it leaves to others.
#include <algorithm>
#include <numeric>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "bench/elastic_system.hpp"
#include "problems/core/front_order.hpp"
#include "problems/core/frontal_factor.hpp"
#include "problems/core/frontal_plan.hpp"
#include "problems/core/solver_entry.hpp"
#include "tests/linear_systems.hpp"
#include "tests/simd_paths.hpp"

namespace strongpoint {
namespace {

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

/// The graph of a lattice whose nodes are coupled as far as `reach` along both axes, numbered at
/// random.
NodeGraph lattice(int width, int length, int reach, std::mt19937_64& generator) {
  std::vector<int> number(width * length);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), generator);
  std::vector<std::vector<int>> neighbours(number.size());
  for (int a = 0; a < width * length; ++a) {
    for (int b = 0; b < width * length; ++b) {
      const int across = std::abs(a % width - b % width);
      const int along = std::abs(a / width - b / width);
      if (a != b && std::max(across, along) <= reach) neighbours[number[a]].push_back(number[b]);
    }
  }
  NodeGraph graph{{0}, {}};
  for (std::vector<int>& ids : neighbours) {
    graph.neighbours.insert(graph.neighbours.end(), ids.begin(), ids.end());
    graph.offsets.push_back(static_cast<int>(graph.neighbours.size()));
  }
  return graph;
}

TEST(NodeGraph, CouplesNodesBothWaysInAscendingOrder) {
  std::mt19937_64 generator(1);
  for (int fields = 1; fields <= 3; ++fields) {
    constexpr int nodes = 40;
    const int size = nodes * fields;
    const Eigen::MatrixXd matrix = sparse_matrix(size, size, 0.03, generator);
    const LinearSystem system = system_of(matrix, random_vector(size, generator), fields);
    const NodeGraph graph = node_graph(view_of(system), fields);
    ASSERT_EQ(graph.size(), nodes);
    for (int a = 0; a < nodes; ++a) {
      std::vector<int> expected;
      for (int b = 0; b < nodes; ++b) {
        const bool is_coupled = !matrix.block(a * fields, b * fields, fields, fields).isZero(0) ||
                                !matrix.block(b * fields, a * fields, fields, fields).isZero(0);
        if (a != b && is_coupled) expected.push_back(b);
      }
      EXPECT_EQ(std::vector<int>(graph.of(a).begin(), graph.of(a).end()), expected);
    }
  }
}

TEST(FrontOrder, SweepsAlongAStrip) {
  std::mt19937_64 generator(2);
  constexpr int width = 8;
  constexpr int reach = 2;
  const NodeGraph graph = lattice(width, 60, reach, generator);
  const std::vector<int> order = front_order(graph);
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < graph.size(); ++i) ASSERT_EQ(sorted[i], i);
  std::size_t widest = 0;
  for (const FrontStep& step : plan_fronts(graph, order, 1)) {
    widest = std::max(widest, step.nodes.size());
  }
  // Line by line there are `reach` lines beside the node, those it brings in and itself.
  EXPECT_LE(widest, static_cast<std::size_t>(width * reach + width));
}

TEST(FrontOrder, NumbersEveryComponent) {
  const NodeGraph graph{{0, 1, 2, 2, 3, 5, 6}, {1, 0, 4, 3, 5, 4}};  // 0-1, 2, 3-4-5
  std::vector<int> order = front_order(graph);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

/// Solves diagonally dominant systems; `round_off` is that of some hundred unknowns, conditions
/// below 100.
template <class Real>
void solves_with_any_number_of_fields(double round_off) {
  on_every_path([&] {
    std::mt19937_64 generator(3);
    for (int fields : {1, 2, 3, 5, 40}) {
      const int size = 5 * (40 + fields) / fields * fields;
      const Eigen::MatrixXd matrix = dominant_matrix(size, 8.0 / size, generator);
      const LinearSystem system = system_of(matrix, random_vector(size, generator), fields);
      const NodeGraph graph = node_graph(view_of(system), fields);
      const FrontalFactor<Real> factor(view_of(system), fields, graph, front_order(graph));
      ASSERT_TRUE(factor.has_factors());
      Eigen::VectorXd x = system.right_hand_side;
      factor.solve(x.data(), x.data());
      EXPECT_LT(difference(x, matrix.partialPivLu().solve(system.right_hand_side)), round_off)
          << fields;
    }
  });
}

TEST(FrontalFactor, SolvesWithAnyNumberOfFieldsOnEveryPath) {
  solves_with_any_number_of_fields<double>(1e-12);
}

TEST(FrontalFactor, SolvesInSinglePrecisionOnEveryPath) {
  solves_with_any_number_of_fields<float>(1e-4);
}

TEST(FrontalFactor, TellsAMatrixThatItHasNoPivotsFor) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(50, 50);
  matrix(20, 20) = 0;
  const LinearSystem system = system_of(matrix, Eigen::VectorXd::Ones(50));
  const NodeGraph graph = node_graph(view_of(system), 1);
  const std::vector<int> order = front_order(graph);
  EXPECT_FALSE(FrontalFactor<double>(view_of(system), 1, graph, order).has_factors());
  EXPECT_FALSE(FrontalFactor<float>(view_of(system), 1, graph, order).has_factors());
}

TEST(Frontal, SolvesElasticityWithTractions) {
  constexpr double round_off = 1e-10;  // condition 1e5
  const KnownSystem known = ElasticSystem<2>({.level = 21, .stencil = "nearest[k=15]"}).assembled();
  on_every_path([&] {
    const LinearSolution solution = solve(known.system, "frontal");
    EXPECT_EQ(solution.solver, "frontal");
    EXPECT_GT(solution.bytes, 0U);
    EXPECT_LT(difference(solution.x, known.solution), round_off);
  });
}

/// Pressures of solids are numbers of another size than displacements, and rows that read
/// displacements alone say nothing of them.
TEST(Frontal, CorrectsFieldsOfAllSizes) {
  constexpr double round_off = 1e-10;
  const KnownSystem known = ElasticSystem<2>({.level = 21, .stencil = "nearest[k=15]"}).assembled();
  LinearSystem system = known.system;
  system.field_axis.clear();  // no components of a vector
  Eigen::VectorXd expected = known.solution;
  constexpr double unit = 1e12;  // of the second field
  for (Eigen::Index i = 1; i < expected.size(); i += 2) expected[i] *= unit;
  for (std::size_t i = 0; i < system.columns.size(); ++i) {
    if (system.columns[i] % 2 == 1) system.values[i] /= unit;
  }
  const LinearSolution solution = solve(system, "frontal");
  EXPECT_EQ(solution.solver, "frontal");
  const auto field = [](const Eigen::VectorXd& x, Eigen::Index f) {
    return Eigen::VectorXd(x(Eigen::seqN(f, x.size() / 2, 2)));
  };
  for (const Eigen::Index f : {0, 1}) {
    EXPECT_LT(difference(field(solution.x, f), field(expected, f)), round_off) << "field " << f;
  }
}

TEST(Frontal, GivesZerosForARightHandSideOfZeros) {
  KnownSystem known = ElasticSystem<2>({.level = 11, .stencil = "nearest[k=15]"}).assembled();
  known.system.right_hand_side.setZero();
  const LinearSolution solution = solve(known.system, "frontal");
  EXPECT_EQ(solution.solver, "frontal");
  EXPECT_TRUE(solution.x.isZero(0));
}

/// Second differences of n values have a condition of 0.4 n^2, 2e8 here, beyond what factors of
/// single precision can correct.
TEST(Frontal, SolvesInDoublePrecisionWhatSingleDoesNotServe) {
  constexpr int n = 20000;
  LinearSystem system;
  for (std::int64_t i = 0; i < n; ++i) {
    for (std::int64_t j = std::max<std::int64_t>(0, i - 1);
         j <= std::min<std::int64_t>(n - 1, i + 1); ++j) {
      system.columns.push_back(j);
      system.values.push_back(i == j ? 1 : -0.5);
    }
    system.offsets.push_back(static_cast<std::int64_t>(system.columns.size()));
  }
  system.right_hand_side = Eigen::VectorXd::Ones(n);
  const LinearSolution solution = solve(system, "frontal");
  EXPECT_EQ(solution.solver, "frontal");
  // The solution is i (n + 1 - i), i from 1.
  const double middle = 0.25 * (n + 1) * (n + 1) - 0.25;
  constexpr double round_off = 1e-7;  // condition times round-off
  EXPECT_NEAR(solution.x[n / 2 - 1] / middle, 1, round_off);
}

/// A shift along a ring: any few nodes have a row that reads nothing of them.
TEST(Frontal, LeavesToFullPivotingWhatPivotsOfAFewRowsDoNotServe) {
  constexpr int n = 200;
  std::mt19937_64 generator(4);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n) * 1e-18;
  for (int i = 0; i < n; ++i) matrix(i, (i + 1) % n) = 1;
  const Eigen::VectorXd x = random_vector(n, generator);
  const LinearSolution solution = solve(system_of(matrix, matrix * x), "frontal");
  EXPECT_EQ(solution.solver, "umfpack");
  EXPECT_LT(solution.residual, 1e-14);
  const std::string message = message_of<CaseError>(
      [] { solve(system_of(Eigen::MatrixXd::Ones(4, 4), Eigen::VectorXd::Ones(4)), "frontal"); });
  EXPECT_NE(message.find("singular"), std::string::npos) << message;
}

}  // namespace
}  // namespace strongpoint
