#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "methods/core/neighbours.hpp"
#include "problems/core/layout.hpp"

namespace strongpoint {

/// Round-off of a few operations on numbers of size 1.
constexpr double round_off = 1e-13;

/// Runs something that must throw a CaseError and gives its message.
template <class Action>
inline std::string message_of(Action action) {
  try {
    action();
  } catch (const CaseError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// A cloud of the unit cube.
template <int Dim>
PointCloud<Dim> unit_cloud(const std::string& spec, int level, std::uint64_t seed = 1) {
  return make_cloud<Dim>(UnitCube<Dim>(), spec, {level, seed});
}

/// Distance of each node to its nearest neighbour, (N).
template <int Dim>
std::vector<double> nearest_distances(const PointCloud<Dim>& cloud) {
  const Stencils near = make_search<Dim>("brute", cloud.nodes)->nearest(cloud.nodes, 2, Ties::cut);
  std::vector<double> distances;
  distances.reserve(cloud.size());
  for (int i = 0; i < cloud.size(); ++i) {
    distances.push_back((cloud.nodes.col(near[i][1]) - cloud.nodes.col(i)).norm());
  }
  return distances;
}

/// Sides of the unit cube that a node lies on, from its coordinates alone.
template <int Dim>
std::vector<int> sides_of(const Point<Dim>& x) {
  std::vector<int> sides;
  for (int c = 0; c < Dim; ++c) {
    if (x[c] == 0) sides.push_back(2 * c);
    if (x[c] == 1) sides.push_back(2 * c + 1);
  }
  return sides;
}

/// Expects the marks of every node to be the sides its coordinates say, with the cube's normals.
template <int Dim>
void expect_cube_marks(const PointCloud<Dim>& cloud) {
  for (int i = 0; i < cloud.size(); ++i) {
    const Point<Dim> x = cloud.nodes.col(i);
    const std::vector<int> expected = sides_of<Dim>(x);
    std::vector<int> found;
    for (const BoundaryMark<Dim>& mark : cloud.marks_of(i)) {
      found.push_back(mark.side);
      // Normals of the cube point away from its centre.
      Point<Dim> outwards = Point<Dim>::Zero();
      outwards[mark.side / 2] = mark.side % 2 == 0 ? -1 : 1;
      EXPECT_EQ(mark.normal, outwards) << "node " << i;
    }
    EXPECT_EQ(found, expected) << "node " << i << " at " << format_point(x);
    EXPECT_EQ(cloud.is_boundary(i), !expected.empty());
  }
}

}  // namespace strongpoint
