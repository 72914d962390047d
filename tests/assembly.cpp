#include "problems/core/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "problems/core/assembly_rows.hpp"
#include "problems/core/column_set.hpp"
#include "problems/core/elasticity.hpp"
#include "problems/core/random.hpp"
#include "tests/random_weights.hpp"

namespace strongpoint {
namespace {

const Derivatives<2> second_order = Derivatives<2>::between_orders(1, 2);

/// Plane elasticity inside, with a Lame constant that may vary; every seventh node is held, every
/// eleventh reads the nodes before it too.
EquationList mixed_equations(int nodes, double lambda, double slope) {
  EquationList list;
  EquationWriter<2> write(list, second_order);
  for (int node = 0; node < nodes; ++node) {
    for (int i = 0; i < 2; ++i) {
      write.at(node);
      if (node % 7 == 0) {
        write.add(i, {}, 2);
      } else {
        add_equilibrium<2>(write, Lame{lambda + slope * node, 1}, i);
      }
      if (node % 11 == 5) {
        write.at(node - 1);
        write.add(1 - i, {1, 0}, 0.5);
      }
      write.equals(node + 0.25 * i);
    }
  }
  return list;
}

/// The same rows, by the definition of a term.
Eigen::MatrixXd dense_rows(const EquationList& equations, const Weights& weights, int nodes) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(equations.size(), 2 * nodes);
  for (int row = 0; row < equations.size(); ++row) {
    for (const Term& term : equations.row(row)) {
      if (term.derivative == value_only) {
        rows(row, 2 * term.point + term.field) += term.coefficient;
        continue;
      }
      const std::span<const int> stencil = weights.nodes(term.point);
      for (std::size_t j = 0; j < stencil.size(); ++j) {
        rows(row, 2 * stencil[j] + term.field) +=
            term.coefficient * weights.row(term.point)(term.derivative, static_cast<int>(j));
      }
    }
  }
  return rows;
}

Eigen::MatrixXd dense_matrix(const LinearSystem& system) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(system.rows(), system.unknowns());
  for (std::int64_t row = 0; row < system.rows(); ++row) {
    for (std::int64_t e = system.offsets[row]; e < system.offsets[row + 1]; ++e) {
      rows(row, system.columns[e]) = system.values[e];
    }
  }
  return rows;
}

void expect_same_bits(const LinearSystem& a, const LinearSystem& b) {
  EXPECT_EQ(a.offsets, b.offsets);
  EXPECT_EQ(a.columns, b.columns);
  EXPECT_EQ(a.values, b.values);
  EXPECT_EQ(a.row_scales, b.row_scales);
  EXPECT_EQ(a.right_hand_side, b.right_hand_side);
}

TEST(Assembly, SortsNodesOfStencilsOfAnySize) {
  std::mt19937_64 generator(1);
  for (const int count : {0, 1, 2, 15, 16, 17, 33, 50, 64, 65, 200}) {
    std::vector<int> ids(count + 16), order(count + 16);
    for (int i = 0; i < count; ++i) {
      ids[i] = 1000 * static_cast<int>(1000 * uniform01(generator)) + i;
    }
    sort_positions(count, ids.data(), order.data());
    for (int i = 1; i < count; ++i) EXPECT_LT(ids[order[i - 1]], ids[order[i]]) << count;
    std::sort(order.begin(), order.begin() + count);
    for (int i = 0; i < count; ++i) EXPECT_EQ(order[i], i) << count;
  }
}

TEST(Assembly, ListsColumnsInAscendingOrder) {
  std::mt19937_64 generator(1);
  ColumnSet set;
  for (const int width : {1, 64, 65, 5000, 300'000}) {
    set.resize(width);
    for (int round = 0; round < 3; ++round) {  // it is empty after each
      std::set<std::int64_t> expected;
      std::int64_t count = 0;
      for (int i = 0; i < 100; ++i) {
        const auto column = static_cast<std::int64_t>(width * uniform01(generator));
        expected.insert(column);
        count += set.insert(column);
      }
      EXPECT_EQ(count, static_cast<std::int64_t>(expected.size()));
      std::vector<std::int64_t> found;
      set.drain([&](std::int64_t column) { found.push_back(column); });
      EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));
    }
  }
}

/// Two rows a node that read gradients, at pairs of points with one stencil, and bare values.
EquationList balances(int nodes, const Derivatives<2>& gradients) {
  EquationList list;
  EquationWriter<2> write(list, gradients);
  for (int node = 0; node < nodes; ++node) {
    for (int i = 0; i < 2; ++i) {
      for (const int point : {node, node ^ 1, (node + 9) % nodes, node}) {
        write.at(point);
        write.add(i, {1, 0}, 1 + 0.125 * node);
        if (node % 3 > 0) write.add(1 - i, {0, 1}, 0.5);
        write.add(i, {1, 0}, 0.25);
      }
      if (node % 5 == 0) write.add_unknown(node, 1 - i, 3);
      write.equals(node);
    }
  }
  return list;
}

TEST(Assembly, AddsUpPointsWithOneStencil) {
  constexpr int nodes = 200;
  constexpr double round_off = 1e-13;  // a dozen summands of up to 26
  const Derivatives<2> gradients = Derivatives<2>::between_orders(1, 1);
  Weights weights = random_weights(nodes, 20, gradients.size());
  for (int p = 0; p < nodes; p += 2) {
    const auto first = weights.columns.begin() + weights.offsets[p];
    std::copy(first, first + 20, first + 20);
  }
  const EquationList equations = balances(nodes, gradients);
  const LinearSystem system = assemble(equations, weights, {.count = nodes}, 2);
  const Eigen::MatrixXd expected = dense_rows(equations, weights, nodes);
  const Eigen::MatrixXd found = dense_matrix(system);
  for (int row = 0; row < equations.size(); ++row) {
    const double scale = system.row_scales[row];
    EXPECT_LT((found.row(row) - scale * expected.row(row)).cwiseAbs().maxCoeff(), round_off);
    const auto first = system.columns.begin() + system.offsets[row];
    EXPECT_TRUE(std::is_sorted(first, system.columns.begin() + system.offsets[row + 1]));
  }
}

TEST(Assembly, KeepsTheTermsOfRowsThatAreAlikeOnce) {
  constexpr int nodes = 700;
  const EquationList alike = mixed_equations(nodes, 1.5, 0);
  const EquationList different = mixed_equations(nodes, 1.5, 0.01);
  EXPECT_LT(alike.terms.size(), 700U);  // rows of several points have terms of their own
  EXPECT_GT(different.terms.size(), 3500U);
  int row = 0;
  for (int node = 0; node < nodes; ++node) {
    for (int i = 0; i < 2; ++i, ++row) {
      const EquationRow terms = alike.row(row);
      EXPECT_EQ(terms.size(), (node % 7 == 0 ? 1 : 3) + (node % 11 == 5 ? 1 : 0));
      EXPECT_EQ(terms.front().point, node);
      EXPECT_EQ(terms.point(), node % 11 == 5 ? own_points : node);
    }
  }
}

TEST(Assembly, AddsUpTheTermsOfEveryKindOfRow) {
  constexpr int nodes = 700;
  // Entries are sums of three products of numbers below 4.
  constexpr double round_off = 1e-14;
  for (const int per_row : {5, 15, 40, 90}) {
    const Weights weights = random_weights(nodes, per_row, second_order.size());
    for (const double slope : {0.0, 0.001}) {
      const EquationList equations = mixed_equations(nodes, 1.5, slope);
      const LinearSystem system = assemble(equations, weights, {.count = nodes}, 2);
      const Eigen::MatrixXd expected = dense_rows(equations, weights, nodes);
      const Eigen::MatrixXd found = dense_matrix(system);
      for (int row = 0; row < equations.size(); ++row) {
        const double scale = system.row_scales[row];
        EXPECT_NEAR(found.row(row).cwiseAbs().maxCoeff(), 1, round_off);
        EXPECT_LT((found.row(row) - scale * expected.row(row)).cwiseAbs().maxCoeff(), round_off);
        EXPECT_DOUBLE_EQ(system.right_hand_side[row], scale * equations.right_hand_sides[row]);
        EXPECT_TRUE(std::is_sorted(system.columns.begin() + system.offsets[row],
                                   system.columns.begin() + system.offsets[row + 1]));
      }
    }
  }
}

TEST(Assembly, GivesTheSameBitsWithAnyNumberOfThreads) {
  constexpr int nodes = 3000;
  const Weights weights = random_weights(nodes, 15, second_order.size());
  const EquationList equations = mixed_equations(nodes, 1.5, 0);
  omp_set_num_threads(1);
  const LinearSystem one = assemble(equations, weights, {.count = nodes}, 2);
  omp_set_num_threads(2);
  expect_same_bits(one, assemble(equations, weights, {.count = nodes}, 2));
}

TEST(Reassembly, GivesTheBitsOfAFreshAssembly) {
  constexpr int nodes = 700;
  const Weights weights = random_weights(nodes, 15, second_order.size());
  LinearSystem system = assemble(mixed_equations(nodes, 1.5, 0), weights, {.count = nodes}, 2);
  const EquationList other = mixed_equations(nodes, 2.5, 0.01);
  reassemble(other, weights, {.count = nodes}, system);
  expect_same_bits(system, assemble(other, weights, {.count = nodes}, 2));
}

std::string message_of_reassembly(const EquationList& equations, const Weights& weights, int nodes,
                                  LinearSystem system) {
  try {
    reassemble(equations, weights, {.count = nodes}, system);
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

TEST(Reassembly, RefusesAnotherPattern) {
  constexpr int nodes = 100;
  const Weights weights = random_weights(nodes, 15, second_order.size());
  const EquationList equations = mixed_equations(nodes, 1.5, 0);
  const LinearSystem system = assemble(equations, weights, {.count = nodes}, 2);
  Weights moved = weights;
  const std::span<const int> stencil = weights.nodes(20);
  int other = 0;
  while (std::count(stencil.begin(), stencil.end(), other) > 0) ++other;
  moved.columns[weights.offsets[20]] = other;
  const std::string message = message_of_reassembly(equations, moved, nodes, system);
  EXPECT_NE(message.find("row 40: its 30 entries"), std::string::npos) << message;
  EXPECT_NE(message.find("assemble the system anew"), std::string::npos) << message;
  const std::string fewer =
      message_of_reassembly(mixed_equations(nodes - 1, 1.5, 0), weights, nodes, system);
  EXPECT_NE(fewer.find("198 equations for 200 unknowns"), std::string::npos) << fewer;
}

}  // namespace
}  // namespace strongpoint
