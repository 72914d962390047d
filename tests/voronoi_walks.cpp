// Voronoi cells in space found by walking along their edges, on every path of the processor.
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "problems/core/cell_maker.hpp"
#include "problems/core/random.hpp"
#include "problems/core/simd/cut_cells.hpp"
#include "problems/core/simd/walk_cells.hpp"
#include "problems/core/voronoi.hpp"
#include "tests/simd_paths.hpp"
#include "tests/voronoi_oracle.hpp"

namespace strongpoint {
namespace {

/// Two ways to the same polyhedron of some thirty vertices differ by round-off, relative.
constexpr double same_cell = 1e-12;

/// Round-off of a few thousand terms of a sum that is 1.
constexpr double sum_round_off = 1e-12;

/// CGAL's circumcentres of the flat tetrahedra over two nodes this far apart lose as many digits.
constexpr double pair_distance = 1e-6;
constexpr double oracle_round_off = 1e-8;

PointCloud<3> cloud_of(Points<3> nodes) {
  PointCloud<3> cloud;
  cloud.nodes = std::move(nodes);
  cloud.mark_offsets.assign(static_cast<std::size_t>(cloud.nodes.cols()) + 1, 0);
  cloud.measure = 1;
  return cloud;
}

PointCloud<3> random_cloud(int count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Points<3> nodes(3, count);
  for (double& x : nodes.reshaped()) x = uniform01(generator);
  return cloud_of(std::move(nodes));
}

/// What walks and cuts make of the cells of some nodes.
struct Found {
  std::vector<double> volumes, farthest_squared;
  std::vector<WalkState> states;

  explicit Found(int count) : volumes(count), farthest_squared(count), states(count) {}
};

Found walk(const Points<3>& nodes, const Stencils& stencils) {
  const int count = stencils.size();
  std::vector<int> chosen(count);
  std::iota(chosen.begin(), chosen.end(), 0);
  Found found(count);
  walk_cells({nodes.data(), chosen.data(), stencils.offsets.data(), stencils.nodes.data(), count,
              static_cast<int>(stencils[0].size()), found.volumes.data(),
              found.farthest_squared.data(), found.states.data()});
  return found;
}

/// The cell of node 0 among the given ones, which come by distance.
Found walk_around_first(const Points<3>& nodes) {
  Stencils stencils;
  stencils.nodes.resize(static_cast<std::size_t>(nodes.cols()));
  std::iota(stencils.nodes.begin(), stencils.nodes.end(), 0);
  stencils.offsets = {0, nodes.cols()};
  return walk(nodes, stencils);
}

TEST(VoronoiWalks, AgreeWithCutsWhereverACellIsBounded) {
  const PointCloud<3> cloud = random_cloud(700, 1);
  const Stencils stencils =
      make_search<3>("auto", cloud.nodes)->nearest(cloud.nodes, 50, Ties::cut);
  const auto work = std::make_unique<CutCell>();
  on_every_path([&] {
    const Found found = walk(cloud.nodes, stencils);
    int whole = 0;
    for (int i = 0; i < cloud.size(); ++i) {
      ASSERT_NE(found.states[i], WalkState::broken) << "node " << i;
      const double half_width = 100;  // no whole cell of these reaches so far
      double volume = 0, farthest_squared = 0;
      CutState state = CutState::broken;
      cut_cells({cloud.nodes.data(), &i, stencils.offsets.data() + i, stencils.nodes.data(), 1,
                 nullptr, 0, &half_width, work.get(), &volume, &farthest_squared, &state});
      ASSERT_EQ(state, CutState::whole);
      if (farthest_squared > 1) continue;  // the cube shows, or hardly an end to a spike
      ++whole;
      ASSERT_EQ(found.states[i], WalkState::whole) << "node " << i;
      ASSERT_NEAR(found.volumes[i], volume, same_cell * volume) << "node " << i;
      ASSERT_NEAR(found.farthest_squared[i], farthest_squared, same_cell) << "node " << i;
    }
    EXPECT_GT(whole, 500);
  });
}

TEST(VoronoiWalks, FindACubeAndATetrahedron) {
  Points<3> six(3, 7);
  six << 0, 1, -1, 0, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 0, 1, -1;
  Points<3> four(3, 5);
  four << 0, 2, 2, -2, -2, 0, 2, -2, 2, -2, 0, 2, -2, -2, 2;
  on_every_path([&] {
    const Found cube = walk_around_first(six);
    EXPECT_EQ(cube.states[0], WalkState::whole);
    EXPECT_DOUBLE_EQ(cube.volumes[0], 1);
    EXPECT_DOUBLE_EQ(cube.farthest_squared[0], 0.75);
    // Faces at a distance of sqrt(3): a regular tetrahedron of inradius r measures 8 sqrt(3) r^3,
    // and its corners are three times as far away.
    const Found tetrahedron = walk_around_first(four);
    EXPECT_EQ(tetrahedron.states[0], WalkState::whole);
    EXPECT_NEAR(tetrahedron.volumes[0], 72, 72 * same_cell);
    EXPECT_NEAR(tetrahedron.farthest_squared[0], 27, 27 * same_cell);
  });
}

TEST(VoronoiWalks, TellCellsWithoutAnEndAndNodesInOnePlace) {
  Points<3> nodes(3, 6);
  nodes << 0, 1, 1, 1, 1, 2, 0, 0.1, 0.5, -0.7, 0.3, 0, 0, 0.2, -0.6, 0.4, 0.9, 1;
  on_every_path([&] {
    EXPECT_EQ(walk_around_first(nodes).states[0], WalkState::unbounded);
    EXPECT_TRUE(std::isinf(walk_around_first(nodes).farthest_squared[0]));
    Points<3> twice = nodes;
    twice.col(1).setZero();
    EXPECT_EQ(walk_around_first(twice).states[0], WalkState::broken);
    EXPECT_TRUE(std::isinf(walk_around_first(twice).farthest_squared[0]));
  });
}

TEST(VoronoiWalks, NeverGiveAWrongCellOfALattice) {
  // All distances tie and eight cells meet in each corner: a walk may fail, not err.
  Points<3> nodes(3, 6 * 6 * 6);
  for (int i = 0; i < nodes.cols(); ++i) {
    for (int c = 0, rest = i; c < 3; ++c, rest /= 6) nodes(c, i) = rest % 6;
  }
  for (double turn : {0.0, 0.3}) {
    const Eigen::Matrix3d turned =
        Eigen::AngleAxisd(turn, Point<3>(1, 2, 3).normalized()).toRotationMatrix();
    const Points<3> lattice = turned * nodes;
    const Stencils stencils = make_search<3>("auto", lattice)->nearest(lattice, 40, Ties::cut);
    on_every_path([&] {
      const Found found = walk(lattice, stencils);
      for (int i = 0; i < nodes.cols(); ++i) {
        const bool is_inside = (nodes.col(i).array() > 0).all() && (nodes.col(i).array() < 5).all();
        if (!is_inside || found.states[i] != WalkState::whole) continue;
        EXPECT_NEAR(found.volumes[i], 1, same_cell) << "node " << i << ", turned by " << turn;
      }
    });
  }
}

TEST(VoronoiWalks, MeasureCellsOfNodesVeryCloseToEachOther) {
  PointCloud<3> cloud = random_cloud(1200, 2);
  std::mt19937_64 generator(3);
  for (int i = 0; i < 100; ++i) {
    for (int c = 0; c < 3; ++c) {
      cloud.nodes(c, 12 * i + 1) =
          cloud.nodes(c, 12 * i) + pair_distance * (uniform01(generator) - 0.5);
    }
  }
  const std::vector<double> expected = cgal_measures(cloud);
  on_every_path([&] {
    const Eigen::VectorXd volumes =
        voronoi_volumes(cloud, UnitCube<3>(), *make_search<3>("auto", cloud.nodes));
    int compared = 0;
    for (int i = 0; i < cloud.size(); ++i) {
      if (expected[i] < 0) continue;
      ASSERT_NEAR(volumes[i], expected[i], oracle_round_off * expected[i]) << "node " << i;
      ++compared;
    }
    EXPECT_GT(compared, 400);
    EXPECT_NEAR(volumes.sum(), 1, sum_round_off);
  });
}

TEST(VoronoiWalks, CellsAreMeasuredAsTheyAreMade) {
  const PointCloud<3> cloud = random_cloud(500, 4);
  const UnitCube<3> cube;
  const auto search = make_search<3>("auto", cloud.nodes);
  const Stencils stencils = search->nearest(cloud.nodes, 64, Ties::cut);
  on_every_path([&] {
    CellMaker<3> maker(cloud, cube);
    for (int i = 0; i < cloud.size(); ++i) {
      const double reach = (cloud.nodes.col(stencils[i].back()) - cloud.nodes.col(i)).norm();
      const CellExtent extent = maker.measure(i, stencils[i], reach);
      ASSERT_EQ(extent.state, maker.make(i, stencils[i], reach)) << "node " << i;
      const double measure = maker.cell().measure();
      ASSERT_NEAR(extent.measure, measure, same_cell * measure) << "node " << i;
      ASSERT_NEAR(extent.farthest_squared, farthest_squared(maker.cell()), same_cell);
    }
  });
}

}  // namespace
}  // namespace strongpoint
