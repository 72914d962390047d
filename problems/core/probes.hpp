#pragma once

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/point_cloud.hpp"

namespace strongpoint {

/// The node at a position, to a millionth of the cloud's spacing. Throws CaseError, naming the
/// nearest node, when none is there.
template <int Dim>
int node_at(const PointCloud<Dim>& cloud, const Point<Dim>& x) {
  constexpr double tolerance = 1e-6;  // a file may round coordinates
  Eigen::Index nearest = 0;
  const double squared = (cloud.nodes.colwise() - x).colwise().squaredNorm().minCoeff(&nearest);
  if (squared > tolerance * tolerance * cloud.spacing() * cloud.spacing()) {
    throw CaseError(fmt::format(
        "the solution is judged at {}, where the cloud has no node (nearest: {} at {}); "
        "put one there",
        format_point(x), nearest, format_point(cloud.nodes.col(nearest))));
  }
  return static_cast<int>(nearest);
}

}  // namespace strongpoint
