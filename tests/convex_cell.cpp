#include "problems/core/convex_cell.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

/// A handful of cuts of a cell of size 1 accumulate no more round-off than this.
constexpr double round_off = 1e-14;

template <int Dim>
ConvexCell<Dim> box(double half) {
  ConvexCell<Dim> cell;
  cell.reset(Point<Dim>::Constant(-half), Point<Dim>::Constant(half));
  return cell;
}

template <int Dim>
Point<Dim> random_direction(std::mt19937_64& generator) {
  while (true) {
    Point<Dim> direction;
    for (int c = 0; c < Dim; ++c) direction[c] = 2 * uniform01(generator) - 1;
    const double length = direction.norm();
    if (length > 0.1 && length < 1) return direction / length;
  }
}

/// Cuts a cell many times; each time both halves must add up, and the smaller offset of the two
/// keeps the origin. Every third plane goes through a vertex, every third through two or three.
template <int Dim>
void expect_halves_add_up(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  ConvexCell<Dim> cell = box<Dim>(1);
  for (int cut = 0; cut < 40; ++cut) {
    Point<Dim> normal = random_direction<Dim>(generator);
    double offset = 0.2 + 0.5 * uniform01(generator);
    const auto pick = [&] {
      const auto count = static_cast<double>(cell.vertices().size());
      return cell.vertices()[static_cast<std::size_t>(uniform01(generator) * count)];
    };
    const Point<Dim> a = pick();
    if (cut % 3 > 0) {
      if (cut % 3 == 2) {
        // A plane that holds the edge or diagonal from a to b.
        const Point<Dim> along = pick() - a;
        if (along.norm() > 1e-6) normal -= normal.dot(along) / along.squaredNorm() * along;
        if (normal.norm() < 1e-3) continue;
        normal.normalize();
      }
      offset = normal.dot(a);
      if (offset < 0.1) continue;
    }
    const double whole = cell.measure();
    ConvexCell<Dim> other = cell;
    other.clip(-normal, -offset);
    cell.clip(normal, offset);
    ASSERT_NEAR(cell.measure() + other.measure(), whole, 1e2 * round_off) << "cut " << cut;
    for (const Point<Dim>& v : cell.vertices()) ASSERT_LE(normal.dot(v), offset + 1e2 * round_off);
    ASSERT_GT(cell.measure(), 0);
  }
}

TEST(ConvexCell, StartsAsABox) {
  EXPECT_DOUBLE_EQ(box<1>(1.5).measure(), 3);
  EXPECT_DOUBLE_EQ(box<2>(1.5).measure(), 9);
  EXPECT_DOUBLE_EQ(box<3>(1.5).measure(), 27);
  EXPECT_DOUBLE_EQ(farthest_squared(box<3>(1.5)), 3 * 2.25);
}

TEST(ConvexCell, TellsWhatAPlaneDid) {
  ConvexCell<1> interval = box<1>(1);
  EXPECT_EQ(interval.clip(Point<1>(-1), 1), Clip::untouched);
  EXPECT_EQ(interval.clip(Point<1>(-1), 0.5), Clip::cut);
  EXPECT_DOUBLE_EQ(interval.measure(), 1.5);
  EXPECT_EQ(interval.clip(Point<1>(1), -2), Clip::emptied);
  EXPECT_EQ(interval.measure(), 0);
  ConvexCell<3> cube = box<3>(1);
  EXPECT_EQ(cube.clip(Point<3>::UnitZ(), 1), Clip::untouched);
  EXPECT_EQ(cube.clip(Point<3>::UnitZ(), 0.25), Clip::cut);
  EXPECT_DOUBLE_EQ(cube.measure(), 5);
  EXPECT_EQ(cube.clip(Point<3>::UnitZ(), -1.5), Clip::emptied);
  EXPECT_EQ(cube.measure(), 0);
  EXPECT_TRUE(cube.vertices().empty());
  EXPECT_EQ(cube.clip(Point<3>::UnitZ(), 5), Clip::emptied);
  EXPECT_EQ(box<2>(1).clip(Point<2>::Constant(NAN), 1), Clip::emptied);
}

TEST(ConvexCell, IsCutExactlyByPlanesThroughVertices) {
  // The diagonal plane through three corners of the cube takes a pyramid of a sixth of [0,2]^3.
  ConvexCell<3> cube = box<3>(1);
  cube.clip(Point<3>::Ones().normalized(), 1 / std::sqrt(3));
  EXPECT_NEAR(cube.measure(), 8 - 8.0 / 6, round_off);
  EXPECT_EQ(cube.vertices().size(), 7U);
  // A plane through two opposite edges halves it, once only.
  cube = box<3>(1);
  const Point<3> diagonal = Point<3>(1, 1, 0).normalized();
  EXPECT_EQ(cube.clip(diagonal, 0), Clip::cut);
  EXPECT_EQ(cube.clip(diagonal, 0), Clip::untouched);
  EXPECT_NEAR(cube.measure(), 4, round_off);
  EXPECT_EQ(cube.vertices().size(), 6U);
  ConvexCell<2> square = box<2>(1);
  EXPECT_EQ(square.clip(Point<2>(1, 1).normalized(), 0), Clip::cut);
  EXPECT_NEAR(square.measure(), 2, round_off);
  EXPECT_EQ(square.vertices().size(), 3U);
}

TEST(ConvexCell, FacesKeepTheLabelsOfTheirPlanes) {
  // One plane through the end of an edge, one through its middle: sums of normals by label.
  ConvexCell<2> square = box<2>(1);
  square.clip(Point<2>(1, 1).normalized(), 0, 7);
  square.clip(Point<2>(-1, 0), 0.5, 8);
  std::array<double, 2> lengths{};
  const std::vector<Point<2>>& corners = square.vertices();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int label = square.label(static_cast<int>(i));
    const double length = (corners[(i + 1) % corners.size()] - corners[i]).norm();
    if (label >= 7) lengths[static_cast<std::size_t>(label - 7)] += length;
  }
  EXPECT_NEAR(lengths[0], 1.5 * std::sqrt(2), round_off);
  EXPECT_NEAR(lengths[1], 1.5, round_off);
  ConvexCell<1> interval = box<1>(1);
  interval.clip(Point<1>(-1), 0.5, 3);
  EXPECT_EQ(interval.label(0), 3);
  EXPECT_EQ(interval.label(1), unlabelled);
  ConvexCell<3> cube = box<3>(1);
  cube.clip(Point<3>::UnitZ(), 0.25, 5);
  ASSERT_EQ(cube.face_count(), 6);
  for (int face = 0; face < 6; ++face) {
    if (cube.label(face) != 5) continue;
    for (int v : cube.face(face)) EXPECT_EQ(cube.vertices()[v][2], 0.25);
  }
}

TEST(ConvexCell, BecomesAnOctahedron) {
  // |x| + |y| + |z| <= 1: volume 4/3, reached from a box whose corners coincide with its own.
  ConvexCell<3> cell = box<3>(1);
  for (int corner = 0; corner < 8; ++corner) {
    const Point<3> normal(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    cell.clip(normal / std::sqrt(3), 1 / std::sqrt(3));
  }
  EXPECT_NEAR(cell.measure(), 4.0 / 3, round_off);
  EXPECT_EQ(cell.vertices().size(), 6U);
  EXPECT_NEAR(farthest_squared(cell), 1, round_off);
}

TEST(ConvexCell, ApproachesADiscOfTangents) {
  ConvexCell<2> cell = box<2>(2);
  constexpr int sides = 64;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * M_PI * i / sides;
    cell.clip(Point<2>(std::cos(angle), std::sin(angle)), 1);
  }
  EXPECT_NEAR(cell.measure(), sides * std::tan(M_PI / sides), 10 * round_off);
}

TEST(ConvexCell, HalvesAddUpForPlanesInAnyPosition) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_halves_add_up<2>(seed);
    expect_halves_add_up<3>(seed);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace strongpoint
