#include "problems/core/reentrant_cells.hpp"

#include <algorithm>

#include "problems/core/cell_faces.hpp"

namespace strongpoint {
namespace {

/// Length along a tangent beyond a piece's end, and back to where it is taken, relative to the
/// piece.
constexpr double step = 1e-3;

/// Sine of the least angle by which a corner is re-entrant.
constexpr double least_sine = 0.05;

/// Corners farther than this many times the reach of a cell's neighbours do not show in it: a cell
/// is half as large as its reach, and a wall that is nearer to one of its corners than the wall in
/// between ends within three times its size when they meet at a right angle or more.
constexpr double far_away = 2;

/// Whether the boundary, followed from one position to another, would go on inside the domain.
bool goes_on_inside(const Domain<2>& domain, const Point<2>& before, const Point<2>& end) {
  const Point<2> along = end - before;
  return domain.distance(end + along) < -least_sine * along.norm();
}

}  // namespace

std::vector<Point<2>> reentrant_corners(const Domain<2>& domain) {
  using Parameter = BoundaryPiece<2>::Parameter;
  std::vector<Point<2>> corners;
  for (const BoundaryPiece<2>& piece : domain.pieces()) {
    for (const double end : {0.0, 1.0}) {
      const Point<2> x = piece.map(Parameter(end));
      const Point<2> before = piece.map(Parameter(end == 0 ? step : 1 - step));
      if (goes_on_inside(domain, before, x)) corners.push_back(x);
    }
  }
  return corners;
}

std::optional<CellExtent> ReentrantCells<2>::measure(int node, std::span<const int> neighbours,
                                                     double reach) {
  const PointCloud<2>& cloud = setting_.faces.cloud;
  const Point<2> centre = cloud.nodes.col(node);
  if (!is_near_corner(centre, reach)) return std::nullopt;
  points_.clear();
  const CellOutcome outcome = add_settled(cloud, maker_, node, neighbours, reach, points_);
  const double farthest_squared = outcome.farthest * outcome.farthest;
  const bool is_bounded = outcome.state != CellState::unbounded;
  const double measure = is_bounded ? cell_measure<2>(centre, points_) : outcome.farthest;
  return CellExtent{outcome.state, measure, farthest_squared};
}

bool ReentrantCells<2>::is_near_corner(const Point<2>& x, double reach) const {
  const double radius = far_away * reach;
  return std::any_of(setting_.corners.begin(), setting_.corners.end(), [&](const Point<2>& corner) {
    return (corner - x).squaredNorm() <= radius * radius;
  });
}

}  // namespace strongpoint
