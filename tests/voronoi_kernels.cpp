// Voronoi cells made side by side and as graphs, on every path of the processor.
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "problems/core/random.hpp"
#include "problems/core/simd/cell_rings.hpp"
#include "problems/core/simd/cut_cells.hpp"
#include "problems/core/voronoi.hpp"
#include "tests/simd_paths.hpp"
#include "tests/voronoi_oracle.hpp"

namespace strongpoint {
namespace {

/// Round-off of a few thousand terms of a sum that is 1.
constexpr double sum_round_off = 1e-12;

/// CGAL computes circumcentres in plain doubles, which lose digits in flat triangles and
/// tetrahedra; graded clouds have more of them.
constexpr double oracle_round_off = 1e-8;

template <int Dim>
PointCloud<Dim> cloud_of(const Points<Dim>& nodes) {
  PointCloud<Dim> cloud;
  cloud.nodes = nodes;
  cloud.mark_offsets.assign(static_cast<std::size_t>(nodes.cols()) + 1, 0);
  cloud.measure = 1;
  return cloud;
}

/// Nodes anywhere in the unit cube, drawn towards its corner at the origin.
template <int Dim>
PointCloud<Dim> graded_cloud(int count, double power) {
  std::mt19937_64 generator(3);
  Points<Dim> nodes(Dim, count);
  for (int i = 0; i < count; ++i) {
    Point<Dim> x;
    for (int c = 0; c < Dim; ++c) x[c] = uniform01(generator);
    nodes.col(i) = std::pow(x.maxCoeff(), power) * x;
  }
  return cloud_of<Dim>(nodes);
}

/// The middles of the n^Dim cells of a grid on the unit cube.
template <int Dim>
PointCloud<Dim> grid_cloud(int n) {
  Points<Dim> nodes(Dim, static_cast<int>(std::lround(std::pow(n, Dim))));
  for (int i = 0; i < nodes.cols(); ++i) {
    for (int c = 0, rest = i; c < Dim; ++c, rest /= n) nodes(c, i) = (rest % n + 0.5) / n;
  }
  return cloud_of<Dim>(nodes);
}

template <int Dim>
Eigen::VectorXd volumes_of(const PointCloud<Dim>& cloud) {
  return voronoi_volumes(cloud, UnitCube<Dim>(), *make_search<Dim>("auto", cloud.nodes));
}

/// Compares all cells that CGAL can judge, on all paths.
template <int Dim>
void expect_oracle(const PointCloud<Dim>& cloud, int at_least) {
  const std::vector<double> expected = cgal_measures(cloud);
  on_every_path([&] {
    const Eigen::VectorXd volumes = volumes_of(cloud);
    int compared = 0;
    for (int i = 0; i < cloud.size(); ++i) {
      if (expected[i] < 0) continue;
      ASSERT_NEAR(volumes[i], expected[i], oracle_round_off * expected[i]) << "node " << i;
      ++compared;
    }
    EXPECT_GT(compared, at_least);
    EXPECT_NEAR(volumes.sum(), 1, sum_round_off);
  });
}

TEST(VoronoiKernels, AgreeWithCgalOnRandomAndGradedClouds) {
  expect_oracle(graded_cloud<2>(3000, 0), 2500);
  expect_oracle(graded_cloud<2>(3000, 2), 2500);
  expect_oracle(graded_cloud<3>(1500, 0), 500);
  expect_oracle(graded_cloud<3>(1500, 1), 500);
}

template <int Dim>
void expect_equal_cells(int n) {
  on_every_path([&] {
    const Eigen::VectorXd volumes = volumes_of(grid_cloud<Dim>(n));
    const double expected = std::pow(n, -Dim);
    EXPECT_LT((volumes.array() - expected).abs().maxCoeff(), sum_round_off * expected) << n;
  });
}

TEST(VoronoiKernels, AreExactOnGridsWhereManyNodesShareACircle) {
  expect_equal_cells<2>(16);
  expect_equal_cells<2>(23);
  expect_equal_cells<3>(8);
  expect_equal_cells<3>(11);
}

TEST(VoronoiKernels, FillTheCubeOnLatticesWithCornersOfFourEdges) {
  // Nodes where the coordinates of a grid add up to an even number: rhombic dodecahedra of twice
  // the volume of a grid cell, wherever the boundary is far enough.
  const PointCloud<3> grid = grid_cloud<3>(12);
  std::vector<int> chosen;
  for (int i = 0; i < grid.size(); ++i) {
    if ((i % 12 + i / 12 % 12 + i / 144) % 2 == 0) chosen.push_back(i);
  }
  const PointCloud<3> cloud = cloud_of<3>(columns_of<3>(grid.nodes, chosen));
  on_every_path([&] {
    const Eigen::VectorXd volumes = volumes_of(cloud);
    EXPECT_NEAR(volumes.sum(), 1, sum_round_off);
    const double expected = 2 * std::pow(12, -3);
    for (int i = 0; i < cloud.size(); ++i) {
      const bool is_inside = (cloud.nodes.col(i).array() - 0.5).abs().maxCoeff() < 0.4;
      if (!is_inside) continue;
      EXPECT_NEAR(volumes[i], expected, sum_round_off * expected) << "node " << i;
    }
  });
}

template <int Dim>
void expect_same_bits_on_threads(int count) {
  const PointCloud<Dim> cloud = graded_cloud<Dim>(count, 1);
  const int before = omp_get_max_threads();
  on_every_path([&] {
    omp_set_num_threads(1);
    const Eigen::VectorXd expected = volumes_of(cloud);
    omp_set_num_threads(2);
    EXPECT_EQ(volumes_of(cloud), expected);
  });
  omp_set_num_threads(before);
}

TEST(VoronoiKernels, GiveTheSameBitsOnOneAndTwoThreads) {
  expect_same_bits_on_threads<2>(3000);
  expect_same_bits_on_threads<3>(1000);
}

TEST(VoronoiKernels, RingsAreTheNeighboursAroundANode) {
  // The eight nodes around the middle one of a grid of nine, its own place first.
  Points<2> nodes(2, 9);
  nodes << 0, 1, 0, -1, 0, 1, -1, -1, 1, 0, 0, 1, 0, -1, 1, 1, -1, -1;
  std::vector<int> ids(9);
  std::iota(ids.begin(), ids.end(), 0);
  const std::vector<std::int64_t> offsets{0, 9};
  const int chosen = 0;
  on_every_path([&] {
    double area = 0, farthest_squared = 0;
    int size = 0;
    std::vector<int> places(most_ring_corners);
    std::vector<double> corners(2 * most_ring_corners);
    find_cell_rings({nodes.data(), &chosen, offsets.data(), ids.data(), 1, 9, &area,
                     &farthest_squared, &size, places.data(), corners.data()});
    EXPECT_DOUBLE_EQ(area, 1);
    EXPECT_DOUBLE_EQ(farthest_squared, 0.5);
    ASSERT_GE(size, 4);
    for (int i = 0; i < size; ++i) {
      const Point<2> arm = nodes.col(places[i]);
      const Point<2> corner(corners[2 * i], corners[2 * i + 1]);
      EXPECT_DOUBLE_EQ(arm.dot(corner), 0.5 * arm.squaredNorm()) << "corner " << i;
    }
  });
}

TEST(VoronoiKernels, CellsThatNothingBoundsAreTold) {
  // All nodes on one side; then one at the place of the node itself.
  Points<2> nodes(2, 5);
  nodes << 0, 1, 1, 2, 2, 0, 0.5, -0.5, 1, -1;
  std::vector<int> ids{0, 1, 2, 3, 4};
  const std::vector<std::int64_t> offsets{0, 5};
  const int chosen = 0;
  on_every_path([&] {
    double area = 0, farthest_squared = 0;
    const RingTask task{nodes.data(), &chosen,           offsets.data(), ids.data(), 1,      5,
                        &area,        &farthest_squared, nullptr,        nullptr,    nullptr};
    find_cell_rings(task);
    EXPECT_TRUE(std::isinf(farthest_squared));
    nodes.col(1).setZero();
    find_cell_rings(task);
    EXPECT_TRUE(std::isinf(farthest_squared));
    nodes.col(1) << 1, 0.5;
  });
}

}  // namespace
}  // namespace strongpoint
