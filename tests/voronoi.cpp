#include "problems/core/voronoi.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "problems/core/random.hpp"
#include "tests/voronoi_oracle.hpp"

namespace strongpoint {
namespace {

/// Cells of a unit domain add up to 1 but for the round-off of a few thousand terms.
constexpr double sum_round_off = 1e-12;

/// CGAL computes circumcentres in plain doubles: those of flat triangles and tetrahedra carry
/// round-off far above the machine's, relative to the cell.
constexpr double oracle_round_off = 1e-9;

/// How far nodes of `cube_cloud` leave the grid, as a fraction of its spacing.
struct Perturbation {
  double amount;
  std::uint64_t seed;
};

/// A grid of n^Dim nodes on the unit cube, boundary nodes marked, interior ones moved.
template <int Dim>
PointCloud<Dim> cube_cloud(int n, Perturbation move = {0, 1}) {
  const UnitCube<Dim> cube;
  std::mt19937_64 generator(move.seed);
  CloudBuilder<Dim> builder;
  const int count = static_cast<int>(std::lround(std::pow(n, Dim)));
  for (int i = 0; i < count; ++i) {
    Point<Dim> x;
    for (int c = 0, rest = i; c < Dim; ++c, rest /= n) x[c] = (rest % n) / (n - 1.0);
    const std::vector<int> sides = cube.sides_at(x);
    const auto marks = cube.marks(sides, x);
    for (int c = 0; c < Dim && sides.empty(); ++c) {
      x[c] += (2 * uniform01(generator) - 1) * move.amount / (n - 1);
    }
    builder.add(x, marks);
  }
  return builder.finish(1);
}

/// Nodes anywhere in the unit cube, none of them on its boundary.
template <int Dim>
PointCloud<Dim> random_cloud(int count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  CloudBuilder<Dim> builder;
  for (int i = 0; i < count; ++i) {
    Point<Dim> x;
    for (int c = 0; c < Dim; ++c) x[c] = uniform01(generator);
    builder.add(x);
  }
  return builder.finish(1);
}

template <int Dim>
Eigen::VectorXd volumes_of(const PointCloud<Dim>& cloud,
                           const Domain<Dim>& domain = UnitCube<Dim>()) {
  return voronoi_volumes(cloud, domain, *make_search<Dim>("auto", cloud.nodes));
}

/// A quarter of a ring, radii 1 to 4; its distance is that of the nearest side, as if sides went
/// on.
class QuarterRing final : public Domain<2> {
 public:
  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"inner", "outer", "bottom", "left"};
    return names;
  }
  double measure() const override { return M_PI / 4 * (16 - 1); }
  double reference_length() const override { return 3; }
  Point<2> map(const Point<2>& unit) const override {
    const double angle = unit[0] * M_PI / 2;
    // Exact on the axes, where the cosine of pi/2 is not 0.
    const Point<2> direction(unit[0] == 1 ? 0 : std::cos(angle),
                             unit[0] == 0 ? 0 : std::sin(angle));
    return (1 + 3 * unit[1]) * direction;
  }
  std::vector<int> sides_at(const Point<2>& unit) const override {
    std::vector<int> found;
    if (unit[1] == 0) found.push_back(0);
    if (unit[1] == 1) found.push_back(1);
    if (unit[0] == 0) found.push_back(2);
    if (unit[0] == 1) found.push_back(3);
    return found;
  }
  Point<2> normal(int side, const Point<2>& x) const override {
    if (side == 0) return -x.normalized();
    if (side == 1) return x.normalized();
    return side == 2 ? Point<2>(0, -1) : Point<2>(-1, 0);
  }
  double distance(const Point<2>& x) const override {
    return std::max({1 - x.norm(), x.norm() - 4, -x[0], -x[1]});
  }
  std::vector<BoundaryPiece<2>> pieces() const override { return {}; }
};

PointCloud<2> ring_cloud(const QuarterRing& ring, int n) {
  CloudBuilder<2> builder;
  for (int i = 0; i < n * n; ++i) {
    const Point<2> unit = Eigen::Vector2i(i / n, i % n).cast<double>() / (n - 1);
    const Point<2> x = ring.map(unit);
    builder.add(x, ring.marks(ring.sides_at(unit), x));
  }
  return builder.finish(ring.measure());
}

/// Compares all cells that CGAL can judge; returns how many there were.
template <int Dim>
int compare_with_cgal(const PointCloud<Dim>& cloud) {
  const Eigen::VectorXd volumes = volumes_of(cloud);
  const std::vector<double> expected = cgal_measures(cloud);
  int compared = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    if (expected[i] < 0 || cloud.is_boundary(i)) continue;
    EXPECT_NEAR(volumes[i], expected[i], oracle_round_off * expected[i]) << "node " << i;
    ++compared;
  }
  EXPECT_NEAR(volumes.sum(), 1, sum_round_off);
  return compared;
}

template <int Dim>
void expect_grid_cells(int n) {
  const PointCloud<Dim> cloud = cube_cloud<Dim>(n);
  const Eigen::VectorXd volumes = volumes_of(cloud);
  for (int i = 0; i < cloud.size(); ++i) {
    // Halved once per side that the node lies on.
    const auto marks = static_cast<double>(cloud.marks_of(i).size());
    const double expected = std::pow(n - 1, -Dim) * std::pow(0.5, marks);
    EXPECT_NEAR(volumes[i], expected, sum_round_off * expected) << "node " << i;
  }
}

TEST(Voronoi, CellsOfAGridAreItsSquares) {
  expect_grid_cells<1>(2);
  expect_grid_cells<1>(11);
  expect_grid_cells<2>(2);
  expect_grid_cells<2>(11);
  expect_grid_cells<2>(30);
  expect_grid_cells<3>(2);
  expect_grid_cells<3>(8);
}

TEST(Voronoi, CellsInALineReachHalfWayToTheNeighbours) {
  PointCloud<1> cloud = cube_cloud<1>(4);
  cloud.nodes << 0, 1, 0.1, 0.7;
  cloud.marks[1].normal[0] = 1;
  cloud.mark_offsets = {0, 1, 2, 2, 2};
  const Eigen::VectorXd volumes = volumes_of(cloud);
  const Eigen::Vector4d expected(0.05, 0.15, 0.35, 0.45);
  EXPECT_LT((volumes - expected).cwiseAbs().maxCoeff(), sum_round_off);
}

TEST(Voronoi, PerturbedCellsAgreeWithCgal) {
  EXPECT_GT(compare_with_cgal(cube_cloud<2>(25, {0.2, 1})), 400);
  EXPECT_GT(compare_with_cgal(cube_cloud<2>(25, {0.4, 2})), 400);
  EXPECT_GT(compare_with_cgal(cube_cloud<3>(10, {0.2, 3})), 300);
  EXPECT_GT(compare_with_cgal(cube_cloud<3>(10, {0.4, 4})), 300);
}

TEST(Voronoi, RandomCellsAgreeWithCgal) {
  EXPECT_GT(compare_with_cgal(random_cloud<2>(2000, 5)), 1500);
  EXPECT_GT(compare_with_cgal(random_cloud<3>(1500, 6)), 500);
  EXPECT_NEAR(volumes_of(random_cloud<1>(500, 7)).sum(), 1, sum_round_off);
}

TEST(Voronoi, AHandfulOfNodesShareTheCube) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    for (int count : {2, 3, 7}) {
      EXPECT_NEAR(volumes_of(random_cloud<2>(count, seed)).sum(), 1, sum_round_off) << seed;
      EXPECT_NEAR(volumes_of(random_cloud<3>(count, seed)).sum(), 1, sum_round_off) << seed;
    }
  }
}

TEST(Voronoi, CellsOfARingConvergeToItsArea) {
  const QuarterRing ring;
  std::vector<double> errors;
  for (int n : {11, 21, 41}) {
    const Eigen::VectorXd volumes = volumes_of(ring_cloud(ring, n), ring);
    errors.push_back(std::abs(volumes.sum() / ring.measure() - 1));
  }
  EXPECT_LT(errors[1], 1e-3);
  // The slivers between arc and tangents are O(h^2) of the area: a factor of 4 a level.
  EXPECT_GT(errors[0] / errors[1], 3.5);
  EXPECT_GT(errors[1] / errors[2], 3.5);
}

TEST(Voronoi, ThreadsAndEnginesAgreeBitwise) {
  const PointCloud<3> cloud = random_cloud<3>(600, 8);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const Eigen::VectorXd expected = volumes_of(cloud);
  omp_set_num_threads(4);
  for (const std::string& engine : search_engines()) {
    const auto search = make_search<3>(engine, cloud.nodes);
    EXPECT_EQ(voronoi_volumes(cloud, UnitCube<3>(), *search), expected) << engine;
  }
  omp_set_num_threads(before);
}

TEST(Voronoi, ANodeWithoutACellIsNamed) {
  PointCloud<2> cloud = cube_cloud<2>(9);
  cloud.nodes.col(40) = cloud.nodes.col(31);
  cloud.nodes.col(50) << 3, 0.5;
  for (const char* word : {"node 31 ", "(0.5, 0.375)"}) {
    try {
      volumes_of(cloud);
      FAIL() << "coincident nodes have no cells";
    } catch (const CaseError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
  cloud = cube_cloud<2>(9);
  cloud.nodes.col(50) << 3, 0.5;
  EXPECT_THROW(volumes_of(cloud), CaseError);
}

}  // namespace
}  // namespace strongpoint
