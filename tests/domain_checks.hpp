#pragma once

#include <functional>
#include <string>
#include <vector>

#include "problems/core/domains/polygon.hpp"
#include "problems/core/voronoi.hpp"
#include "tests/cloud_checks.hpp"

namespace strongpoint {

/// How far a point is from each side's line or surface, in the order of the sides; from closed
/// forms, not from the domain.
template <int Dim>
using SideGaps = std::function<std::vector<double>(const Point<Dim>&)>;

/// Lengths of size 1 to 50 after a few operations.
constexpr double gap_tolerance = 1e-11;

/// Expects every node in the domain, with exactly the marks of the sides that hold it.
template <int Dim>
void expect_nodes_on_their_sides(const Domain<Dim>& domain, const PointCloud<Dim>& cloud,
                                 const SideGaps<Dim>& gaps) {
  for (int i = 0; i < cloud.size(); ++i) {
    const Point<Dim> x = cloud.nodes.col(i);
    EXPECT_LT(domain.distance(x), gap_tolerance) << format_point(x);
    const std::vector<double> all = gaps(x);
    std::vector<int> expected, found;
    for (int side = 0; side < static_cast<int>(all.size()); ++side) {
      if (std::abs(all[side]) < gap_tolerance) expected.push_back(side);
    }
    for (const auto& mark : cloud.marks_of(i)) found.push_back(mark.side);
    EXPECT_EQ(found, expected) << format_point(x);
    EXPECT_EQ(std::abs(domain.distance(x)) < gap_tolerance, !expected.empty()) << format_point(x);
  }
}

/// Expects the normal of a node on one side to be the gradient of the distance there.
template <int Dim>
void expect_normals_along_the_distance(const Domain<Dim>& domain, const PointCloud<Dim>& cloud) {
  constexpr double step = 1e-5;
  int compared = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    if (cloud.marks_of(i).size() != 1) continue;
    const Point<Dim> normal = cloud.marks_of(i)[0].normal;
    const Point<Dim> x = cloud.nodes.col(i) - 2 * step * normal;
    Point<Dim> gradient;
    for (int c = 0; c < Dim; ++c) {
      const Point<Dim> shift = step * Point<Dim>::Unit(c);
      gradient[c] = (domain.distance(x + shift) - domain.distance(x - shift)) / (2 * step);
    }
    // The quotient's truncation on circles, and round-off over the step.
    EXPECT_LT((gradient - normal).norm(), 1e-8) << format_point(x);
    ++compared;
  }
  EXPECT_GT(compared, 10);
}

/// Expects nodes neither much closer than wanted nor with gaps: the nearest neighbour lies within
/// [least, most] of the spacing.
template <int Dim>
void expect_even(const Domain<Dim>& domain, const PointCloud<Dim>& cloud, int level, double least,
                 double most) {
  const std::vector<double> distances = nearest_distances(cloud);
  for (int i = 0; i < cloud.size(); ++i) {
    const Point<Dim> x = cloud.nodes.col(i);
    const double ratio = distances[i] / domain.spacing(x, level);
    EXPECT_GT(ratio, least) << format_point(x);
    EXPECT_LT(ratio, most) << format_point(x);
  }
}

/// Sum of the Voronoi cells over the domain's measure.
template <int Dim>
double covered_share(const Domain<Dim>& domain, const PointCloud<Dim>& cloud) {
  return voronoi_volumes<Dim>(cloud, domain, *make_search<Dim>("auto", cloud.nodes)).sum() /
         domain.measure();
}

/// The feature of a name.
template <int Dim>
Feature<Dim> feature(const Domain<Dim>& domain, const std::string& name) {
  for (const Feature<Dim>& candidate : domain.features()) {
    if (candidate.name == name) return candidate;
  }
  ADD_FAILURE() << "no feature " << name;
  return {};
}

/// Cook's membrane, its spacing shrinking to `grade` at the corners.
inline Polygon cook(double grade = 1) {
  return Polygon({{0, 0}, {48, 44}, {48, 60}, {0, 44}}, {"bottom", "right", "top", "clamped"}, 48,
                 {grade, 20});
}

/// A square of side 2 without its upper right quarter; all sides but the left share a name.
inline Polygon notched() {
  return Polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                 {"free", "free", "free", "free", "free", "left"}, 2);
}

}  // namespace strongpoint
