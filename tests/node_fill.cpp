#include "problems/core/node_fill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "problems/core/random.hpp"
#include "problems/core/structured.hpp"
#include "tests/cloud_checks.hpp"

namespace strongpoint {
namespace {

/// Quarter of an annulus, 1 < r < 4, whose wanted spacing grows from the inside outwards 20 times.
class GradedAnnulus final : public Domain<2> {
 public:
  static constexpr double outer = 4, growth = 20;
  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"inner", "bottom", "outer", "left"};
    return names;
  }
  double measure() const override { return std::numbers::pi / 4 * (outer * outer - 1); }
  double reference_length() const override { return std::numbers::pi / 2; }
  Point<2> map(const Point<2>& unit) const override {
    return polar(1 + (outer - 1) * unit[1], unit[0]);
  }
  std::vector<int> sides_at(const Point<2>& unit) const override {
    std::vector<int> found;
    if (unit[1] == 0) found.push_back(0);
    if (unit[0] == 0) found.push_back(1);
    if (unit[1] == 1) found.push_back(2);
    if (unit[0] == 1) found.push_back(3);
    return found;
  }
  Point<2> normal(int side, const Point<2>& x) const override {
    const std::vector<Point<2>> all{-x.normalized(), {0, -1}, x.normalized(), {-1, 0}};
    return all[side];
  }
  double distance(const Point<2>& x) const override {
    return std::max({1 - x.norm(), x.norm() - outer, -x[0], -x[1]});
  }
  std::vector<BoundaryPiece<2>> pieces() const override {
    using Parameter = BoundaryPiece<2>::Parameter;
    return {{0, [](const Parameter& t) { return polar(1, t[0]); }},
            {1, [](const Parameter& t) { return polar(1 + (outer - 1) * t[0], 0); }},
            {2, [](const Parameter& t) { return polar(outer, t[0]); }},
            {3, [](const Parameter& t) { return polar(1 + (outer - 1) * t[0], 1); }}};
  }
  double spacing(const Point<2>& x, int level) const override {
    const double exponent = std::log(growth) / std::log(outer);
    return reference_length() / (level - 1) * std::pow(x.norm(), exponent);
  }

 private:
  static Point<2> polar(double r, double turn) {
    // Exact at the ends, as a domain's sides must be.
    if (turn == 0) return {r, 0};
    if (turn == 1) return {0, r};
    const double angle = turn * std::numbers::pi / 2;
    return {r * std::cos(angle), r * std::sin(angle)};
  }
};

/// Octant of the shell 1 < r < 2. Each spherical face is one piece with a rim collapsed at the
/// pole.
class ShellOctant final : public Domain<3> {
 public:
  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"inner", "outer", "x0", "y0", "z0"};
    return names;
  }
  double measure() const override { return std::numbers::pi / 6 * 7; }
  double reference_length() const override { return 1; }
  Point<3> map(const Point<3>& u) const override { return spherical(1 + u[0], u[1], u[2]); }
  std::vector<int> sides_at(const Point<3>&) const override { return {}; }
  Point<3> normal(int side, const Point<3>& x) const override {
    if (side < 2) return (side == 0 ? -1 : 1) * x.normalized();
    return -Point<3>::Unit(side - 2);
  }
  double distance(const Point<3>& x) const override {
    return std::max({1 - x.norm(), x.norm() - 2, -x.minCoeff()});
  }
  std::vector<BoundaryPiece<3>> pieces() const override {
    using Parameter = BoundaryPiece<3>::Parameter;
    return {{0, [](const Parameter& t) { return spherical(1, t[0], t[1]); }},
            {1, [](const Parameter& t) { return spherical(2, t[0], t[1]); }},
            {2, [](const Parameter& t) { return spherical(1 + t[0], t[1], 1); }},
            {3, [](const Parameter& t) { return spherical(1 + t[0], t[1], 0); }},
            {4, [](const Parameter& t) { return spherical(1 + t[0], 1, t[1]); }}};
  }

 private:
  static Point<3> spherical(double r, double polar, double around) {
    const double a = polar * std::numbers::pi / 2, b = around * std::numbers::pi / 2;
    return r * Point<3>(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  }
};

TEST(PointTree, FindsWhatBruteForceFinds) {
  std::mt19937_64 generator(3);
  // A box that covers a small part of the points: the tree must not depend on it.
  PointTree<3> tree(Point<3>::Zero(), Point<3>::Constant(0.1));
  for (int i = 0; i < 500; ++i) {
    const Point<3> x(uniform01(generator), uniform01(generator), std::pow(uniform01(generator), 8));
    const double radius = 0.2 * uniform01(generator);
    bool expected = false;
    for (int other = 0; other < tree.size(); ++other) {
      expected = expected || (tree[other] - x).norm() < radius;
    }
    const int found = tree.find_within(x, radius);
    ASSERT_EQ(found >= 0, expected) << "point " << i;
    if (found >= 0) {
      ASSERT_LT((tree[found] - x).norm(), radius);
    }
    tree.add(x);
  }
}

TEST(CurveMarch, FollowsTheIntegralOfTheDensity) {
  const Curve<1> line = [](double t) { return Point<1>(t * t); };  // badly parametrised on purpose
  const SpacingFunction<1> spacing = [](const Point<1>& x) { return 0.01 * (1 + x[0]); };
  const std::vector<double> parameters = march(line, spacing);
  // 100 ln 2 = 69.3 intervals, nodes at 2^(k/69) - 1.
  ASSERT_EQ(parameters.size(), 70U);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double expected = std::exp2(static_cast<double>(k) / 69) - 1;
    EXPECT_NEAR(line(parameters[k])[0], expected, 1e-5);  // 1e-3 of a spacing
  }
}

TEST(CurveMarch, RefusesASpacingThatIsNotPositive) {
  const Curve<1> line = [](double t) { return Point<1>(t); };
  const std::string message =
      message_of([&] { march<1>(line, [](const Point<1>& x) { return 0.5 - x[0]; }); });
  EXPECT_NE(message.find("must be a positive number"), std::string::npos) << message;
}

TEST(Grid, FollowsTheMapOfTheDomain) {
  const GradedAnnulus annulus;
  const PointCloud<2> cloud = make_cloud<2>(annulus, "grid", {5, 1});
  EXPECT_NEAR(cloud.nodes.col(2 * 5 + 4).norm(), 4, round_off);
  ASSERT_EQ(cloud.marks_of(2 * 5 + 4).size(), 1U);
  const Point<2> diagonal = Point<2>(1, 1).normalized();
  EXPECT_LT((cloud.marks_of(2 * 5 + 4)[0].normal - diagonal).norm(), round_off);
  EXPECT_EQ(cloud.marks_of(0).size(), 2U);
}

template <int Dim>
void expect_blue_noise(int level, double count_tolerance) {
  const PointCloud<Dim> cloud = unit_cloud<Dim>("scattered", level);
  const double h = 1.0 / (level - 1);
  expect_cube_marks(cloud);
  EXPECT_FALSE(cloud.block.has_value());
  EXPECT_NEAR(cloud.size() / std::pow(level, Dim), 1, count_tolerance);
  const std::vector<double> distances = nearest_distances(cloud);
  EXPECT_GT(*std::min_element(distances.begin(), distances.end()), 0.9 * h);
  EXPECT_LT(*std::max_element(distances.begin(), distances.end()), 1.01 * h);
  // Probes on a lattice much finer than h find every hole to within 5 %.
  const int side = 10 * level / Dim;
  std::array<std::vector<double>, Dim> axes;
  axes.fill(graded_axis(side, 1));
  const Points<Dim> probes = tensor_lattice<Dim>(axes).nodes;
  const auto search = make_search<Dim>("nanoflann", cloud.nodes);
  const Stencils near = search->nearest(probes, 1, Ties::cut);
  double largest_hole = 0;
  for (int i = 0; i < near.size(); ++i) {
    largest_hole = std::max(largest_hole, (probes.col(i) - cloud.nodes.col(near[i][0])).norm());
  }
  EXPECT_LT(largest_hole, 1.1 * h);
}

TEST(Scattered, IsDenseEvenAndFreeOfHoles) {
  expect_blue_noise<2>(41, 0.05);
  expect_blue_noise<3>(13, 0.05);
}

TEST(Scattered, IsTheGridInOneDimension) {
  const PointCloud<1> cloud = unit_cloud<1>("scattered", 11);
  ASSERT_EQ(cloud.size(), 11);
  expect_cube_marks(cloud);
  std::vector<double> sorted(cloud.nodes.data(), cloud.nodes.data() + 11);
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < 11; ++i) EXPECT_NEAR(sorted[i], 0.1 * i, 1e-12);
}

TEST(Scattered, WorksAtTheLowestLevels) {
  EXPECT_EQ(unit_cloud<2>("scattered", 2).size(), 4);
  EXPECT_EQ(unit_cloud<3>("scattered", 2).size(), 8);
  EXPECT_EQ(unit_cloud<2>("scattered", 3).size(), 9);
}

TEST(Scattered, FollowsASpacingThatGrowsTwentyfold) {
  const GradedAnnulus annulus;
  const int level = 81;
  const PointCloud<2> cloud = make_cloud<2>(annulus, "scattered", {level, 1});
  const std::vector<double> distances = nearest_distances(cloud);
  for (int i = 0; i < cloud.size(); ++i) {
    const double ratio = distances[i] / annulus.spacing(cloud.nodes.col(i), level);
    EXPECT_GT(ratio, 0.75) << format_point(cloud.nodes.col(i));
    EXPECT_LT(ratio, 1.15) << format_point(cloud.nodes.col(i));
  }
  // The integral of 1 / h^2 over the annulus: the nodes an ideal cloud of that spacing has.
  const double exponent = std::log(20.0) / std::log(4.0), h = annulus.spacing({1, 0}, level);
  const double power = 2 - 2 * exponent;
  const double expected = std::numbers::pi / 2 * (std::pow(4, power) - 1) / power / (h * h);
  EXPECT_NEAR(cloud.size() / expected, 1, 0.1);
}

TEST(Scattered, PutsTheNodesAskedForOnACurvedSide) {
  const GradedAnnulus annulus;
  const PointCloud<2> cloud = make_cloud<2>(annulus, "scattered", {41, 1});
  int on_inner = 0, corners = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    const auto marks = cloud.marks_of(i);
    corners += marks.size() == 2 ? 1 : 0;
    if (marks.empty() || marks[0].side != 0) continue;
    ++on_inner;
    EXPECT_NEAR(cloud.nodes.col(i).norm(), 1, round_off);
    EXPECT_LT((marks[0].normal + cloud.nodes.col(i)).norm(), round_off);
  }
  EXPECT_EQ(on_inner, 41);
  EXPECT_EQ(corners, 4);
}

TEST(Scattered, FillsCurvedFacesWithACollapsedRim) {
  const ShellOctant shell;
  const double h = 0.1;
  const PointCloud<3> cloud = make_cloud<3>(shell, "scattered", {11, 1});
  CloudBuilder<3> outer;
  for (int i = 0; i < cloud.size(); ++i) {
    const Point<3> x = cloud.nodes.col(i);
    EXPECT_LT(shell.distance(x), 1e-12);
    for (const BoundaryMark<3>& mark : cloud.marks_of(i)) {
      EXPECT_NEAR(shell.distance(x), 0, 1e-12);
      if (mark.side == 1) outer.add(x);
    }
  }
  // Area over the area per node, half cells at the rims: 2 pi / h^2 + 3 pi / (2 h) + 1.
  EXPECT_NEAR(outer.size() / (2 * std::numbers::pi / (h * h) + 1.5 * std::numbers::pi / h + 1), 1,
              0.06);
  const double expected = shell.measure() / (h * h * h);
  EXPECT_GT(cloud.size(), expected);
  EXPECT_LT(cloud.size(), 1.3 * expected);  // half a layer of nodes more on 11 h^2 of boundary
  for (const auto& distances : {nearest_distances(cloud), nearest_distances(outer.finish(1))}) {
    EXPECT_GT(*std::min_element(distances.begin(), distances.end()), 0.85 * h);
    EXPECT_LT(*std::max_element(distances.begin(), distances.end()), 1.1 * h);
  }
}

TEST(Random, HasAsManyNodesAsTheGrid) {
  EXPECT_EQ(unit_cloud<1>("random", 11).size(), 11);
  EXPECT_EQ(unit_cloud<2>("random", 21).size(), 441);
  const PointCloud<3> cloud = unit_cloud<3>("random", 9);
  EXPECT_NEAR(cloud.size(), 729, 0.05 * 729);  // its faces are scattered
  expect_cube_marks(cloud);
}

TEST(Random, IsUniformAndKeepsNodesApart) {
  const int level = 41;
  const PointCloud<2> cloud = unit_cloud<2>("random", level);
  const double h = 1.0 / (level - 1);
  const std::vector<double> distances = nearest_distances(cloud);
  EXPECT_GE(*std::min_element(distances.begin(), distances.end()), 0.05 * h);
  // Independent nodes come closer to each other than any blue noise does.
  EXPECT_LT(*std::min_element(distances.begin(), distances.end()), 0.3 * h);
  std::array<int, 4> quadrants{};
  for (int i = 0; i < cloud.size(); ++i) {
    if (cloud.is_boundary(i)) continue;
    ++quadrants[(cloud.nodes(0, i) > 0.5 ? 2 : 0) + (cloud.nodes(1, i) > 0.5 ? 1 : 0)];
  }
  // 1521 / 4 with a standard deviation of 17: five of them.
  for (int count : quadrants) EXPECT_NEAR(count, 380, 85);
}

}  // namespace
}  // namespace strongpoint
