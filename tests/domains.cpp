// Domains of the problems: their clouds lie on their sides, their normals, distances and measures
// agree, and spacings are kept.
#include <cmath>
#include <numbers>
#include <random>

#include "problems/core/domains/bored_block.hpp"
#include "problems/core/domains/polygon.hpp"
#include "problems/core/domains/quarter_annulus.hpp"
#include "problems/core/domains/quarter_plate.hpp"
#include "problems/core/domains/shell_octant.hpp"
#include "problems/core/random.hpp"
#include "tests/domain_checks.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;
using Point3 = Point<3>;

/// Share of a domain that tangents to concave arcs cut off its cells, at the levels below.
constexpr double covered_tolerance = 1e-3;

/// Gaps of Cook's membrane from its sides' equations.
std::vector<double> cook_gaps(const Point2& x) {
  return {(x[1] - 44 * x[0] / 48) * std::cos(std::atan2(44.0, 48.0)), x[0] - 48,
          (x[1] - 44 - x[0] / 3) * std::cos(std::atan(1.0 / 3)), x[0]};
}

TEST(Polygon, MapsCooksMembraneAsDefined) {
  const Polygon membrane = cook();
  for (const Point2& unit : {Point2(0.25, 0.5), Point2(1, 0.3), Point2(0.7, 1), Point2(0, 0.1)}) {
    const double s = unit[0], t = unit[1];
    const Point2 expected(48 * s, 44 * s + t * (44 * (1 - s) + 16 * s));
    EXPECT_LT((membrane.map(unit) - expected).norm(), gap_tolerance);
  }
  EXPECT_DOUBLE_EQ(membrane.measure(), 1440);
  const PointCloud<2> cloud = make_cloud<2>(membrane, "grid", {11, 1});
  EXPECT_EQ(cloud.size(), 121);
  expect_nodes_on_their_sides<2>(membrane, cloud, cook_gaps);
  expect_normals_along_the_distance(membrane, cloud);
}

TEST(Polygon, ScattersNodesOnCooksMembrane) {
  const Polygon membrane = cook();
  const PointCloud<2> cloud = make_cloud<2>(membrane, "scattered", {21, 1});
  expect_nodes_on_their_sides<2>(membrane, cloud, cook_gaps);
  expect_normals_along_the_distance(membrane, cloud);
  expect_even(membrane, cloud, 21, 0.75, 1.15);  // 2 sin(47.5 / 2 degrees) at the corner (0,0)
  EXPECT_NEAR(covered_share(membrane, cloud), 1, 1e-12);
  // A node for each h^2, half for each h of the 174 along the boundary.
  const double h = 48.0 / 20;
  EXPECT_NEAR(cloud.size() / (1440 / (h * h) + 0.5 * 174.2 / h), 1, 0.06);
}

TEST(Polygon, GradesTheSpacingTowardsItsCorners) {
  const Polygon membrane = cook(0.1);
  EXPECT_DOUBLE_EQ(membrane.spacing({48, 60}, 13), 0.1 * 4);
  EXPECT_DOUBLE_EQ(membrane.spacing({48, 50}, 13), 4 * (0.1 + 0.9 * 6 / 20));
  EXPECT_DOUBLE_EQ(membrane.spacing({24, 37}, 13), 4);
  const PointCloud<2> cloud = make_cloud<2>(membrane, "scattered", {13, 1});
  expect_nodes_on_their_sides<2>(membrane, cloud, cook_gaps);
  expect_even(membrane, cloud, 13, 0.7, 1.3);
}

TEST(Polygon, HasExactDistancesAtReentrantCorners) {
  const Polygon shape = notched();
  EXPECT_DOUBLE_EQ(shape.measure(), 3);
  EXPECT_DOUBLE_EQ(shape.distance({0.7, 0.6}), -0.5);  // the corner (1,1) is nearest
  EXPECT_DOUBLE_EQ(shape.distance({1.5, 1.25}), 0.25);
  EXPECT_DOUBLE_EQ(shape.distance({5, -4}), 5);
  EXPECT_DOUBLE_EQ(shape.distance({0.5, 1.75}), -0.25);
  ASSERT_EQ(shape.sides(), (std::vector<std::string>{"free", "left"}));
  // Between edges of one side the mean normal, elsewhere the nearest edge's.
  EXPECT_LT((shape.normal(0, {1, 1}) - Point2(1, 1).normalized()).norm(), round_off);
  EXPECT_EQ(shape.normal(0, {1.5, 1.1}), Point2(0, 1));
  EXPECT_EQ(shape.normal(1, {1, 1}), Point2(-1, 0));
}

TEST(Polygon, FillsAroundAReentrantCorner) {
  const Polygon shape = notched();
  const PointCloud<2> cloud = make_cloud<2>(shape, "scattered", {31, 1});
  for (int i = 0; i < cloud.size(); ++i) {
    const Point2 x = cloud.nodes.col(i);
    EXPECT_FALSE(x[0] > 1 + gap_tolerance && x[1] > 1 + gap_tolerance);
    EXPECT_EQ(shape.distance(x) > -gap_tolerance, cloud.is_boundary(i)) << format_point(x);
  }
  expect_even(shape, cloud, 31, 0.85, 1.15);
}

TEST(Polygon, IsTheSameEitherWayRound) {
  const Polygon left({{0, 0}, {1, 0}, {0, 1}}, {"a", "b", "c"}, 1);
  const Polygon right({{0, 0}, {0, 1}, {1, 0}}, {"c", "b", "a"}, 1);
  EXPECT_EQ(left.measure(), right.measure());
  EXPECT_EQ(left.distance({0.2, 0.3}), right.distance({0.2, 0.3}));
  EXPECT_EQ(left.normal(0, {0.5, 0}), right.normal(2, {0.5, 0}));
}

TEST(Polygon, RefusesAMapUnlessItIsAConvexQuadrilateral) {
  EXPECT_THROW(make_cloud<2>(notched(), "grid", {5, 1}), SkipCase);
  const Polygon dart({{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}, {"a", "b", "c", "d"}, 1);
  EXPECT_THROW(make_cloud<2>(dart, "perturbed", {5, 1}), SkipCase);
}

TEST(Polygon, RefusesEdgesThatMeet) {
  const std::vector<std::string> names{"a", "b", "c", "d"};
  const std::string crossing = message_of([&] {
    Polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, names, 1);
  });
  EXPECT_NE(crossing.find("edges 1 and 3"), std::string::npos) << crossing;
  EXPECT_THROW(Polygon({{0, 0}, {2, 0}, {1, 0}, {0, 1}}, names, 1), CaseError);  // folds back
  EXPECT_THROW(Polygon({{0, 0}, {2, 0}, {1, 0}}, {"a", "b", "c"}, 1), CaseError);
  EXPECT_THROW(Polygon({{0, 0}, {2, 0}, {0, 1}}, {"a", "b"}, 1), CaseError);
}

std::vector<double> annulus_gaps(const Point2& x) {
  return {x.norm() - 1, x.norm() - 4, x[1], x[0]};
}

TEST(QuarterAnnulus, HasIsotropicCellsWhenRadiiAreGeometric) {
  const QuarterAnnulus annulus(1, 4, Radii::geometric);
  const PointCloud<2> cloud = make_cloud<2>(annulus, "grid", {9, 1});
  expect_nodes_on_their_sides<2>(annulus, cloud, annulus_gaps);
  expect_normals_along_the_distance(annulus, cloud);
  EXPECT_NEAR(cloud.nodes.col(4 * 9 + 4).norm(), 2, round_off);
  const QuarterAnnulus uniform(1, 4, Radii::uniform);
  const PointCloud<2> polar = make_cloud<2>(uniform, "grid", {9, 1});
  expect_nodes_on_their_sides<2>(uniform, polar, annulus_gaps);
  EXPECT_NEAR(polar.nodes.col(4 * 9 + 4).norm(), 2.5, round_off);
}

TEST(QuarterAnnulus, ScattersNodesEvenly) {
  for (const Radii radii : {Radii::geometric, Radii::uniform}) {
    const QuarterAnnulus annulus(1, 4, radii);
    const PointCloud<2> cloud = make_cloud<2>(annulus, "scattered", {31, 1});
    expect_nodes_on_their_sides<2>(annulus, cloud, annulus_gaps);
    expect_normals_along_the_distance(annulus, cloud);
    expect_even(annulus, cloud, 31, 0.85, 1.15);
    EXPECT_NEAR(covered_share(annulus, cloud), 1, covered_tolerance);
    // The integral of 1 / h^2, and half of that of 1 / h along the boundary.
    const double n = 30, pi = std::numbers::pi;
    const double expected = radii == Radii::geometric
                                ? 2 * std::log(4.0) / pi * n * n + n + 2 / pi * std::log(4.0) * n
                                : annulus.measure() * n * n / 9 + 0.5 * (2.5 * pi + 6) * n / 3;
    EXPECT_NEAR(cloud.size() / expected, 1, 0.06);
  }
}

TEST(QuarterPlate, ScattersNodesEvenly) {
  const QuarterPlate plate(0.2, QuarterPlate::Map::log);
  const PointCloud<2> cloud = make_cloud<2>(plate, "scattered", {31, 1});
  expect_nodes_on_their_sides<2>(plate, cloud, [](const Point2& x) -> std::vector<double> {
    return {x.norm() - 0.2, x[1], x[0] - 1, x[1] - 1, x[0]};
  });
  expect_normals_along_the_distance(plate, cloud);
  expect_even(plate, cloud, 31, 0.8, 1.2);
  EXPECT_NEAR(covered_share(plate, cloud), 1, covered_tolerance);
}

std::vector<double> shell_gaps(const Point3& x) {
  return {x.norm() - 1, x.norm() - 2, x[0], x[1], x[2]};
}

TEST(ShellOctant, ScattersNodesEvenly) {
  const ShellOctant shell(1, 2);
  const int level = 17;
  const PointCloud<3> cloud = make_cloud<3>(shell, "scattered", {level, 1});
  expect_nodes_on_their_sides<3>(shell, cloud, shell_gaps);
  expect_normals_along_the_distance(shell, cloud);
  expect_even(shell, cloud, level, 0.8, 1.15);
  EXPECT_NEAR(covered_share(shell, cloud), 1, covered_tolerance);
  const double h = std::numbers::pi / 2 / (level - 1);
  const double expected = std::numbers::pi / 2 * std::numbers::ln2 / (h * h * h);
  EXPECT_GT(cloud.size(), expected);
  EXPECT_LT(cloud.size(), 1.5 * expected);  // with the outer halves of the cells on the boundary
}

TEST(ShellOctant, SkipsStructuredLayouts) {
  EXPECT_THROW(make_cloud<3>(ShellOctant(1, 2), "grid", {5, 1}), SkipCase);
  EXPECT_THROW(make_cloud<3>(BoredBlock(), "perturbed", {5, 1}), SkipCase);
}

std::vector<double> block_gaps(const Point3& x) {
  return {x.norm() - 2, x[0], x[1], x[2], x[0] - 5, x[1] - 2.5, x[2] - 3};
}

TEST(BoredBlock, ScattersNodesEvenly) {
  const BoredBlock block;
  const int level = 15;
  const PointCloud<3> cloud = make_cloud<3>(block, "scattered", {level, 1});
  expect_nodes_on_their_sides<3>(block, cloud, block_gaps);
  expect_normals_along_the_distance(block, cloud);
  expect_even(block, cloud, level, 0.7, 1.2);
  EXPECT_NEAR(covered_share(block, cloud), 1, covered_tolerance);
}

TEST(BoredBlock, HasAboutAsManyNodesAsALevelSays) {
  for (const int level : {15, 20, 32}) {
    const PointCloud<3> cloud = make_cloud<3>(BoredBlock(), "scattered", {level, 1});
    EXPECT_NEAR(std::cbrt(cloud.size()) / level, 1, 0.03) << cloud.size();
  }
}

TEST(BoredBlock, IsFinestAtTheLigament) {
  const BoredBlock block;
  const double h0 = block.spacing({0, 2.25, 0}, 20);
  EXPECT_DOUBLE_EQ(block.spacing({0, 2, 0}, 20), h0);
  EXPECT_DOUBLE_EQ(block.spacing({5, 2.5, 3}, 20), 2.5 * h0);
  EXPECT_DOUBLE_EQ(block.spacing({0, 0, 2}, 20), std::min(1.5 * h0, h0 + 0.05 * std::sqrt(8.0)));
}

}  // namespace
}  // namespace strongpoint
