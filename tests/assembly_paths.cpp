// Rows that kernels make, on every path of the processor, against rows made one after the other.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "methods/core/simd/output.hpp"
#include "problems/core/assembly.hpp"
#include "problems/core/assembly_rows.hpp"
#include "problems/core/elasticity.hpp"
#include "tests/random_weights.hpp"
#include "tests/simd_paths.hpp"

namespace strongpoint {
namespace {

const Derivatives<2> second_order = Derivatives<2>::between_orders(1, 2);

/// The Laplacian of one field, or the equilibrium of two, at each node.
EquationList plain_equations(int nodes, int fields, const Derivatives<2>& derivatives) {
  EquationList list;
  EquationWriter<2> write(list, derivatives);
  for (int node = 0; node < nodes; ++node) {
    write.at(node);
    for (int i = 0; i < fields; ++i) {
      if (fields == 1) {
        write.add(0, {2, 0}, 1);
        write.add(0, {0, 2}, 1);
      } else {
        add_equilibrium<2>(write, Lame{2, 1}, i);
      }
      write.equals(node);
    }
  }
  return list;
}

/// Rows of a system that are not those which `RowMaker` makes, one after the other.
int rows_that_differ(const LinearSystem& system, const RowSources& sources) {
  constexpr double round_off = 1e-14;  // of sums of five products at most
  RowMaker maker(sources);
  int others = 0;
  for (int row = 0; row < system.rows(); ++row) {
    maker.make(row);
    const std::int64_t begin = system.offsets[row];
    bool is_same =
        system.offsets[row + 1] - begin == static_cast<std::int64_t>(maker.columns().size());
    for (std::size_t e = 0; is_same && e < maker.columns().size(); ++e) {
      is_same = system.columns[begin + e] == maker.columns()[e] &&
                std::abs(system.values[begin + e] - maker.values()[e] * system.row_scales[row]) <=
                    round_off;
    }
    others += is_same ? 0 : 1;
  }
  return others;
}

TEST(AssemblyPaths, WritesLargeSystemsPastTheCaches) {
  for (const int fields : {1, 2}) {
    const int nodes = 80000 / (fields * fields);
    const Weights weights = random_weights(nodes, 30, second_order.size());
    const EquationList equations = plain_equations(nodes, fields, second_order);
    const NodeUnknowns unknowns{.count = nodes};
    on_every_path([&] {
      const LinearSystem system = assemble(equations, weights, unknowns, fields);
      ASSERT_GE(system.values.size(), least_streamed);
      EXPECT_EQ(rows_that_differ(system, {equations, weights, unknowns, fields}), 0);
    });
  }
}

/// Up to sixteen nodes fit into a register of the widest path.
TEST(AssemblyPaths, MakeRowsOfTwoDerivativesAtAnyNumberOfNodes) {
  const Derivatives<2> laplacian({{2, 0}, {0, 2}});
  constexpr int nodes = 50;
  const NodeUnknowns unknowns{.count = nodes};
  for (int per_row = 1; per_row <= 19; ++per_row) {
    const Weights weights = random_weights(nodes, per_row, laplacian.size());
    const EquationList equations = plain_equations(nodes, 1, laplacian);
    on_every_path([&] {
      const LinearSystem system = assemble(equations, weights, unknowns, 1);
      EXPECT_EQ(rows_that_differ(system, {equations, weights, unknowns, 1}), 0) << per_row;
    });
  }
}

/// All of three derivatives, in packs the last of which overlaps the one before.
TEST(AssemblyPaths, MakeRowsOfThreeDerivativesAtAnyNumberOfNodes) {
  const Derivatives<2> second = Derivatives<2>::between_orders(2, 2);
  constexpr int nodes = 70;
  const NodeUnknowns unknowns{.count = nodes};
  EquationList equations;
  EquationWriter<2> write(equations, second);
  for (int node = 0; node < nodes; ++node) {
    write.at(node);
    write.add(0, {2, 0}, 1);
    write.add(0, {1, 1}, 0.5);
    write.add(0, {0, 2}, 2);
    write.equals(node);
  }
  for (const int per_row : {1, 3, 4, 5, 7, 8, 9, 17, 31, 33, 64}) {
    const Weights weights = random_weights(nodes, per_row, second.size());
    on_every_path([&] {
      const LinearSystem system = assemble(equations, weights, unknowns, 1);
      EXPECT_EQ(rows_that_differ(system, {equations, weights, unknowns, 1}), 0) << per_row;
    });
  }
}

/// Equilibrium reads three of the five derivatives.
TEST(AssemblyPaths, MakeRowsOfTwoFieldsAtAnyNumberOfNodes) {
  constexpr int nodes = 50;
  const NodeUnknowns unknowns{.count = nodes};
  const EquationList equations = plain_equations(nodes, 2, second_order);
  for (int per_row = 1; per_row <= 19; ++per_row) {
    const Weights weights = random_weights(nodes, per_row, second_order.size());
    on_every_path([&] {
      LinearSystem system = assemble(equations, weights, unknowns, 2);
      EXPECT_EQ(rows_that_differ(system, {equations, weights, unknowns, 2}), 0) << per_row;
      const LargeArray<double> values = system.values;
      reassemble(equations, weights, unknowns, system);
      EXPECT_EQ(system.values, values) << per_row;
    });
  }
}

/// Of one field, where first derivatives are there and not read.
TEST(AssemblyPaths, LeaveOutDerivativesThatNoRowReads) {
  constexpr int nodes = 50;
  const NodeUnknowns unknowns{.count = nodes};
  const EquationList equations = plain_equations(nodes, 1, second_order);
  for (const int per_row : {1, 7, 16, 30}) {
    Weights weights = random_weights(nodes, per_row, second_order.size());
    weights.values[0] = std::numeric_limits<double>::quiet_NaN();  // of the first derivative
    on_every_path([&] {
      const LinearSystem system = assemble(equations, weights, unknowns, 1);
      EXPECT_EQ(rows_that_differ(system, {equations, weights, unknowns, 1}), 0) << per_row;
    });
  }
}

/// In whichever lane of a register it is.
TEST(AssemblyPaths, RefuseWeightsOfTwoFieldsThatAreNotFinite) {
  const Derivatives<2> second = Derivatives<2>::between_orders(2, 2);
  constexpr int nodes = 40;
  constexpr int per_row = 15;
  const EquationList equations = plain_equations(nodes, 2, second);
  for (int place = 0; place < second.size() * per_row; ++place) {
    for (const double bad :
         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      Weights weights = random_weights(nodes, per_row, second.size());
      weights.values[weights.offsets[17] * second.size() + place] = bad;
      on_every_path([&] {
        EXPECT_THROW(assemble(equations, weights, {.count = nodes}, 2), CaseError) << place;
      });
    }
  }
}

/// In whichever lane of a register it is.
TEST(AssemblyPaths, RefuseWeightsThatAreNotFinite) {
  const Derivatives<2> laplacian({{2, 0}, {0, 2}});
  constexpr int nodes = 40;
  constexpr int per_row = 15;
  const EquationList equations = plain_equations(nodes, 1, laplacian);
  for (int place = 0; place < 2 * per_row; ++place) {
    for (const double bad :
         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      Weights weights = random_weights(nodes, per_row, laplacian.size());
      weights.values[weights.offsets[17] * laplacian.size() + place] = bad;
      on_every_path([&] {
        EXPECT_THROW(assemble(equations, weights, {.count = nodes}, 1), CaseError) << place;
      });
    }
  }
}

}  // namespace
}  // namespace strongpoint
