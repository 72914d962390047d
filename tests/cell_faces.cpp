#include "problems/core/cell_faces.hpp"

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/problem.hpp"
#include "problems/core/random.hpp"
#include "problems/core/voronoi.hpp"
#include "tests/cloud_checks.hpp"
#include "tests/face_checks.hpp"
#include "tests/face_domains.hpp"

namespace strongpoint {
namespace {

/// What interpolants along curved sides may leave, as `cell_faces` promises.
constexpr double curve_error = 1e-10;

/// Nodes anywhere in a domain, none of them on its boundary on purpose.
PointCloud<2> free_cloud(const Domain<2>& domain, int count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  CloudBuilder<2> builder;
  while (builder.size() < count) {
    Point<2> x;
    for (int c = 0; c < 2; ++c) x[c] = 2 * uniform01(generator) - 1;
    if (domain.distance(x) < 0) builder.add(x);
  }
  return builder.finish(domain.measure());
}

/// Points on a side lie on it and look outwards.
void expect_points_on_sides(const Domain<2>& domain, const CellFaces<2>& faces) {
  for (const FacePoint<2>& point : faces.points) {
    if (point.side < 0) continue;
    EXPECT_LT(std::abs(domain.distance(point.x)), curve_error);
    const double cosine = domain.normal(point.side, point.x).dot(point.area.normalized());
    EXPECT_GT(cosine, 1 - curve_error) << "at " << format_point(point.x);
  }
}

/// All that holds of any cloud in 2D.
void expect_good_cells(const PointCloud<2>& cloud, const Domain<2>& domain) {
  const CellFaces<2> faces = faces_of(cloud, domain);
  ASSERT_EQ(faces.size(), cloud.size());
  expect_closed_cells(cloud, faces);
  expect_shared_faces(cloud, faces);
  expect_points_on_sides(domain, faces);
  EXPECT_NEAR(total_measure(cloud, faces), domain.measure(), curve_error * domain.measure());
}

void expect_good_clouds(const Domain<2>& domain, const std::vector<int>& levels) {
  for (const char* layout : {"scattered", "random"}) {
    for (int level : levels) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(std::string(layout) + " level " + std::to_string(level) + " seed " +
                     std::to_string(seed));
        expect_good_cells(make_cloud<2>(domain, layout, {level, seed}), domain);
      }
    }
  }
}

void expect_side_lengths(const Domain<2>& domain, const std::vector<double>& expected) {
  const CellFaces<2> faces = faces_of(make_cloud<2>(domain, "scattered", {21, 1}), domain);
  const std::vector<double> lengths = side_measures(domain, faces);
  for (std::size_t side = 0; side < expected.size(); ++side) {
    EXPECT_NEAR(lengths[side], expected[side], curve_error) << domain.sides()[side];
  }
}

const Domain<2>& plate() {
  static const NamedProblem problem = make_problem("plate_hole");
  return std::get<std::unique_ptr<Problem<2>>>(problem.made)->domain();
}

TEST(CellFaces, CellsShareTheSquare) {
  expect_good_clouds(UnitCube<2>(), {4, 11, 31});
  for (int level : {2, 3, 12}) expect_good_cells(unit_cloud<2>("grid", level), UnitCube<2>());
  expect_side_lengths(UnitCube<2>(), {1, 1, 1, 1});
}

TEST(CellFaces, CellsFollowCurvedSides) {
  expect_good_clouds(RingDomain(), {5, 11, 31});
  expect_side_lengths(RingDomain(), {2 * M_PI * RingDomain::inner, 2 * M_PI * RingDomain::outer});
  expect_good_clouds(plate(), {7, 13});
  for (int level : {5, 12}) {
    expect_good_cells(make_cloud<2>(plate(), "grid", {level, 1}), plate());
  }
}

TEST(CellFaces, SidesInOneLineAreToldApart) {
  const PolygonDomain square({{0, 0}, {0.4, 0}, {1, 0}, {1, 1}, {0, 1}});
  expect_good_clouds(square, {5, 12});
  expect_side_lengths(square, {0.4, 0.6, 1, 1, 1});
}

TEST(CellFaces, CellsFillReentrantCorners) {
  expect_good_clouds(l_shape(), {5, 11, 31});
  expect_side_lengths(l_shape(), {1, 0.5, 0.5, 0.5, 0.5, 1});
}

TEST(CellFaces, CellsEndAtBothWallsOfANotch) {
  // Coarse clouds put cells across the notch.
  expect_good_clouds(notched_square(), {5, 11, 31});
  expect_side_lengths(notched_square(), {1, 1, 0.48, 0.6, 0.04, 0.6, 0.48, 1});
}

TEST(CellFaces, CellsReachTheBoundaryWithoutNodesOnIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (int count : {40, 300}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " nodes " + std::to_string(count));
      expect_good_cells(free_cloud(UnitCube<2>(), count, seed), UnitCube<2>());
      expect_good_cells(free_cloud(l_shape(), count, seed), l_shape());
      expect_good_cells(free_cloud(RingDomain(), count, seed), RingDomain());
    }
  }
}

TEST(CellFaces, ACornerThatNobodyAnnouncedIsCutOffFinely) {
  const PolygonDomain silent = l_shape(Corners::secret);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PointCloud<2> cloud = free_cloud(silent, 60, seed);
    const CellFaces<2> faces = faces_of(cloud, silent);
    expect_closed_cells(cloud, faces);
    expect_shared_faces(cloud, faces);
    // Six corners, each less than half a square of 2^-8 of a cell wide.
    EXPECT_NEAR(total_measure(cloud, faces), silent.measure(), 1e-5);
  }
}

TEST(CellFaces, AHandfulOfNodesShareTheSquare) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    for (int count : {2, 3, 7}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " nodes " + std::to_string(count));
      expect_good_cells(free_cloud(UnitCube<2>(), count, seed), UnitCube<2>());
    }
  }
}

TEST(CellFaces, MeasuresAreThoseOfVoronoiVolumesOnPolygons) {
  const PolygonDomain pentagon({{0, 0}, {1, -0.2}, {1.3, 0.5}, {0.6, 1.1}, {-0.2, 0.7}});
  const PolygonDomain corner = l_shape(), notched = notched_square();
  for (const PolygonDomain* polygon : {&pentagon, &corner, &notched}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const PointCloud<2> cloud = make_cloud<2>(*polygon, "scattered", {17, seed});
      const CellFaces<2> faces = faces_of(cloud, *polygon);
      const Eigen::VectorXd volumes =
          voronoi_volumes(cloud, *polygon, *make_search<2>("auto", cloud.nodes));
      for (int i = 0; i < cloud.size(); ++i) {
        const double measure = cell_measure<2>(cloud.nodes.col(i), faces.of(i));
        // Tangent planes of slanted sides come from central differences.
        EXPECT_NEAR(measure, volumes[i], 1e-9 * measure) << "node " << i;
      }
    }
  }
}

TEST(CellFaces, FluxesOfDivergenceFreeFieldsBalance) {
  const PolygonDomain notched = notched_square();
  const std::array<const Domain<2>*, 2> domains{&plate(), &notched};
  for (const Domain<2>* domain : domains) {
    const PointCloud<2> cloud = make_cloud<2>(*domain, "scattered", {15, 2});
    const CellFaces<2> faces = faces_of(cloud, *domain);
    for (int i = 0; i < cloud.size(); ++i) {
      double linear = 0, quadratic = 0, length = 0;
      for (const FacePoint<2>& point : faces.of(i)) {
        const double x = point.x[0], y = point.x[1];
        linear += Point<2>(2 * x + y - 1, 3 * x - 2 * y).dot(point.area);
        quadratic += Point<2>(x * x - y * y, -2 * x * y).dot(point.area);
        length += point.area.norm();
      }
      EXPECT_LT(std::abs(linear), curve_error * length) << "node " << i;
      EXPECT_LT(std::abs(quadratic), curve_error * length) << "node " << i;
    }
  }
}

TEST(CellFaces, IntegralsOverCellsAddUp) {
  // Over the square of x^2 y; over the ring of x^2, by polar coordinates.
  const UnitCube<2> square;
  const RingDomain ring;
  const auto total = [](const Domain<2>& domain, auto f) {
    const PointCloud<2> cloud = make_cloud<2>(domain, "scattered", {13, 1});
    const CellFaces<2> faces = faces_of(cloud, domain, 3);
    double sum = 0;
    for (int i = 0; i < cloud.size(); ++i) {
      sum += integrate_over_cell<2>(cloud.nodes.col(i), faces.of(i), f);
    }
    return sum;
  };
  EXPECT_NEAR(total(square, [](const Point<2>& x) { return x[0] * x[0] * x[1]; }), 1.0 / 6,
              sum_round_off);
  const double expected =
      M_PI / 4 * (std::pow(RingDomain::outer, 4) - std::pow(RingDomain::inner, 4));
  EXPECT_NEAR(total(ring, [](const Point<2>& x) { return x[0] * x[0]; }), expected, curve_error);
}

TEST(CellFaces, ThreadsAndEnginesAgreeBitwise) {
  const PointCloud<2> cloud = make_cloud<2>(plate(), "scattered", {15, 1});
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const CellFaces<2> expected = faces_of(cloud, plate());
  omp_set_num_threads(4);
  for (const std::string& engine : search_engines()) {
    const CellFaces<2> faces =
        cell_faces<2>(cloud, plate(), *make_search<2>(engine, cloud.nodes), 2);
    ASSERT_EQ(faces.offsets, expected.offsets) << engine;
    for (std::size_t i = 0; i < faces.points.size(); ++i) {
      ASSERT_EQ(faces.points[i].x, expected.points[i].x) << engine;
      ASSERT_EQ(faces.points[i].area, expected.points[i].area) << engine;
      ASSERT_EQ(faces.points[i].side, expected.points[i].side) << engine;
    }
  }
  omp_set_num_threads(before);
}

TEST(CellFaces, ANodeWithoutACellIsNamed) {
  PointCloud<2> cloud = unit_cloud<2>("grid", 9);
  cloud.nodes.col(40) = cloud.nodes.col(31);
  const std::string message = message_of([&] { faces_of<2>(cloud, UnitCube<2>()); });
  EXPECT_NE(message.find("node 31 "), std::string::npos) << message;
  EXPECT_NE(message.find("(0.375, 0.5)"), std::string::npos) << message;
  cloud = unit_cloud<2>("grid", 9);
  cloud.nodes.col(50) << 3, 0.5;
  EXPECT_THROW(faces_of<2>(cloud, UnitCube<2>()), CaseError);
  EXPECT_THROW(faces_of<2>(unit_cloud<2>("grid", 9), UnitCube<2>(), 5), std::invalid_argument);
}

/// [0,1]^2 without a disc that covers less than one per cent of it, and of which it tells nothing.
class PiercedSquare final : public UnmappedDomain {
 public:
  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"left", "right", "bottom", "top", "hole"};
    return names;
  }
  double measure() const override { return 1 - M_PI * radius * radius; }
  double reference_length() const override { return 1; }
  Point<2> normal(int side, const Point<2>& x) const override {
    return side < 4 ? square_.normal(side, x) : Point<2>((centre() - x).normalized());
  }
  double distance(const Point<2>& x) const override {
    return std::max(square_.distance(x), radius - (x - centre()).norm());
  }
  std::vector<BoundaryPiece<2>> pieces() const override { return square_.pieces(); }

 private:
  static constexpr double radius = 0.05;
  static Point<2> centre() { return {0.58, 0.58}; }
  UnitCube<2> square_;
};

TEST(CellFaces, AHoleInsideACellIsMissed) {
  const PiercedSquare domain;
  CloudBuilder<2> builder;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) builder.add({(i + 0.5) / 3, (j + 0.5) / 3});
  }
  const std::string missed =
      message_of([&] { faces_of<2>(builder.finish(domain.measure()), domain); });
  EXPECT_NE(missed.find("cells measure 1, the domain 0.992146"), std::string::npos) << missed;
}

TEST(CellFaces, ABoundaryThatCannotBeFollowedIsNamed) {
  // Three nodes are too few for the hole of a ring: a cell is right, or it is named.
  const RingDomain ring;
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PointCloud<2> cloud = free_cloud(ring, 3, seed);
    try {
      EXPECT_NEAR(total_measure(cloud, faces_of(cloud, ring)), ring.measure(), curve_error);
    } catch (const CaseError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("could not be followed"), std::string::npos) << message;
      ++named;
    }
  }
  EXPECT_GT(named, 0);
}

}  // namespace
}  // namespace strongpoint
