#include "methods/core/hilbert.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <omp.h>

#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

template <int Dim>
using Cell = std::array<std::uint32_t, Dim>;

/// All cells of a cube along the curve; empty when two claim one place.
template <int Dim>
std::vector<Cell<Dim>> cells_along_curve(int levels) {
  const std::uint32_t side = 1U << levels;
  const std::uint32_t mask = side - 1;
  const std::size_t count = std::size_t{1} << (levels * Dim);
  std::vector<Cell<Dim>> cells(count);
  std::vector<int> taken(count, 0);
  for (std::size_t id = 0; id < count; ++id) {
    Cell<Dim> cell;
    for (int c = 0; c < Dim; ++c) cell[c] = static_cast<std::uint32_t>(id >> (c * levels)) & mask;
    const std::uint64_t place = hilbert_place<Dim>(cell, levels);
    if (place >= count || ++taken[place] > 1) return {};
    cells[place] = cell;
  }
  return cells;
}

template <int Dim>
int steps_between(const Cell<Dim>& a, const Cell<Dim>& b) {
  int steps = 0;
  for (int c = 0; c < Dim; ++c) steps += std::abs(static_cast<int>(a[c]) - static_cast<int>(b[c]));
  return steps;
}

template <int Dim>
void expect_curve_through_all_cells(int levels) {
  const std::vector<Cell<Dim>> cells = cells_along_curve<Dim>(levels);
  ASSERT_FALSE(cells.empty());
  EXPECT_EQ(cells[0], Cell<Dim>{});
  for (std::size_t i = 1; i < cells.size(); ++i) {
    ASSERT_EQ(steps_between<Dim>(cells[i - 1], cells[i]), 1) << "at place " << i;
  }
}

template <int Dim>
Points<Dim> random_points(int count) {
  std::mt19937_64 generator(1);
  Points<Dim> points(Dim, count);
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < Dim; ++c) points(c, i) = uniform01(generator);
  }
  return points;
}

/// Mean distance between points that follow each other.
template <int Dim>
double mean_step(const Points<Dim>& points, const std::vector<int>& order) {
  double sum = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    sum += (points.col(order[i]) - points.col(order[i - 1])).norm();
  }
  return sum / static_cast<double>(order.size() - 1);
}

TEST(Hilbert, PassesEveryCellOnceAndStepsAcrossFaces) {
  expect_curve_through_all_cells<1>(8);
  expect_curve_through_all_cells<2>(1);
  expect_curve_through_all_cells<2>(6);
  expect_curve_through_all_cells<3>(1);
  expect_curve_through_all_cells<3>(4);
}

TEST(Hilbert, PassesACubeBeforeItLeavesIt) {
  for (const Cell<3>& cell : cells_along_curve<3>(3)) {
    const Cell<3> parent{cell[0] / 2, cell[1] / 2, cell[2] / 2};
    EXPECT_EQ(hilbert_place<3>(cell, 3) / 8, hilbert_place<3>(parent, 2));
  }
}

TEST(Hilbert, OrdersPointsAsTheCellsTheyLieIn) {
  // The corners of the unit square, each in a quarter of its own.
  Points<2> corners(2, 4);
  corners << 1, 0, 1, 0, 1, 0, 0, 1;
  const std::vector<int> order = hilbert_order<2>(corners);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_DOUBLE_EQ((corners.col(order[i]) - corners.col(order[i - 1])).norm(), 1);
  }
  EXPECT_EQ(order[0], 1);
}

TEST(Hilbert, NamesEveryPointOnceAndKeepsStepsShort) {
  constexpr int count = 5000;
  const Points<2> plane = random_points<2>(count);
  const Points<3> space = random_points<3>(count);
  std::vector<int> order = hilbert_order<2>(plane);
  EXPECT_LT(mean_step<2>(plane, order), 1.1 / std::sqrt(count));  // 0.98 and 1.04 spacings measured
  EXPECT_LT(mean_step<3>(space, hilbert_order<3>(space)), 1.2 / std::cbrt(count));
  std::sort(order.begin(), order.end());
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

TEST(Hilbert, KeepsTheOrderOfPointsAtOnePlace) {
  const Points<3> same = Points<3>::Constant(3, 5, 0.25);
  EXPECT_EQ(hilbert_order<3>(same), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(hilbert_order<2>(Points<2>(2, 0)).empty());
}

TEST(Hilbert, OrdersALineByItsCoordinate) {
  Points<1> line(1, 4);
  line << 3, -1, 2, 0;
  EXPECT_EQ(hilbert_order<1>(line), (std::vector<int>{1, 3, 2, 0}));
}

TEST(Hilbert, TellsNodesOfAGradedCloudApart) {
  // Fine nodes near a corner, all in one cell of the leading bits of a place.
  constexpr int count = 2000;
  Points<2> points = random_points<2>(count);
  points.leftCols(count - 1) *= 1e-4;
  points.col(count - 1) = Point<2>(1, 1);
  EXPECT_LT(mean_step<2>(points, hilbert_order<2>(points)),
            1.1e-4 / std::sqrt(count) + 1.5 / count);
}

TEST(Hilbert, GivesTheSameOrderWithAnyNumberOfThreads) {
  const Points<2> points = random_points<2>(5000);
  omp_set_num_threads(1);
  const std::vector<int> one = hilbert_order<2>(points);
  omp_set_num_threads(2);
  EXPECT_EQ(hilbert_order<2>(points), one);
}

}  // namespace
}  // namespace strongpoint
