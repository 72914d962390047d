#include "problems/core/line_crossings.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "problems/core/boundary_arc.hpp"
#include "tests/face_domains.hpp"

namespace strongpoint {
namespace {

/// Roots of distances of size 1 come out to a few units in the last place.
constexpr double round_off = 1e-14;

std::vector<double> crossings(const Domain<2>& domain, const Point<2>& from, const Point<2>& to) {
  std::vector<double> found;
  find_crossings<2>(domain, {from, to, domain.distance(from), domain.distance(to)},
                    (to - from).norm() / 64, found);
  return found;
}

void expect_crossings(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], round_off);
}

TEST(LineCrossings, AreTheRootsOfTheDistanceInOrder) {
  const RingDomain ring;
  // Through both circles, twice each.
  const double outer = RingDomain::outer / 4, inner = RingDomain::inner / 4;
  expect_crossings(crossings(ring, {-2, 0}, {2, 0}),
                   {0.5 - outer, 0.5 - inner, 0.5 + inner, 0.5 + outer});
  expect_crossings(crossings(ring, {0.5, 0}, {0.9, 0}), {});
  expect_crossings(crossings(ring, {0.5, 0}, {1.5, 0}), {0.5});
  expect_crossings(crossings(notched_square(), {0.2, 0.7}, {0.8, 0.7}), {0.28 / 0.6, 0.32 / 0.6});
}

TEST(LineCrossings, AreFoundWhereALineGrazesTheBoundary) {
  const RingDomain ring;
  for (double depth : {1e-2, 1e-4, 1e-6, 1e-9}) {
    // A chord of the hole of this height, shifted so that no sample falls on its middle.
    const double y = RingDomain::inner - depth;
    const double half = std::sqrt(RingDomain::inner * RingDomain::inner - y * y);
    const std::vector<double> found = crossings(ring, {-0.51, y}, {0.53, y});
    ASSERT_EQ(found.size(), 2U) << depth;
    // The distance is almost flat there: its round-off is divided by the slope.
    const double conditioned = 4 * round_off / half;
    EXPECT_NEAR(found[0], (0.51 - half) / 1.04, conditioned) << depth;
    EXPECT_NEAR(found[1], (0.51 + half) / 1.04, conditioned) << depth;
    EXPECT_TRUE(crossings(ring, {-0.51, y + 2 * depth}, {0.53, y + 2 * depth}).empty());
  }
}

TEST(LineCrossings, AreFoundAtTheEndOfAStretchOnTheBoundary) {
  std::vector<double> found;
  const PolygonDomain square({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  find_crossings<2>(square, {{0.3, 0}, {1.7, 0}, 0, square.distance({1.7, 0}), 1e-13}, 0.01, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0], 0.5, 1e-12);
}

double length_of(const std::vector<FacePoint<2>>& points) {
  double sum = 0;
  for (const FacePoint<2>& point : points) sum += point.area.norm();
  return sum;
}

TEST(BoundaryArc, FollowsCirclesAndKeepsTheAreaOfTheChord) {
  const RingDomain ring;
  for (double angle : {0.01, 0.3, 1.0, 2.0}) {
    for (double radius : {RingDomain::inner, RingDomain::outer}) {
      // The domain to the left: backwards around the hole.
      const double turn = radius == RingDomain::outer ? angle : -angle;
      const Point<2> from(radius, 0);
      const Point<2> to(radius * std::cos(turn), radius * std::sin(turn));
      BoundaryArc arc(ring, 2);
      std::vector<FacePoint<2>> points;
      arc.trace(from, to, points);
      EXPECT_NEAR(length_of(points), radius * angle, 1e-11) << angle;
      Point<2> sum(from[1] - to[1], to[0] - from[0]);
      for (const FacePoint<2>& point : points) {
        sum += point.area;
        EXPECT_LT(std::abs(ring.distance(point.x)), round_off);
      }
      EXPECT_LT(sum.norm(), round_off) << angle;
    }
  }
}

TEST(BoundaryArc, PutsFewPointsOnStraightSides) {
  const PolygonDomain square({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  for (int gauss = 1; gauss <= 4; ++gauss) {
    BoundaryArc arc(square, gauss);
    std::vector<FacePoint<2>> points;
    arc.trace({0.2, 0}, {0.7, 0}, points);
    EXPECT_EQ(points.size(), static_cast<std::size_t>(gauss));
    EXPECT_NEAR(length_of(points), 0.5, round_off);
  }
}

}  // namespace
}  // namespace strongpoint
