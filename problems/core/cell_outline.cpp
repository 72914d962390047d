#include "problems/core/cell_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "problems/core/distance_gradient.hpp"
#include "problems/core/line_crossings.hpp"
#include "problems/core/side_finder.hpp"

namespace strongpoint {
namespace {

/// Features of the boundary smaller than this fraction of a cell may be missed on its faces.
constexpr double resolution = 1.0 / 64;

/// Corners nearer than this fraction of the cell to a crossing or to each other are one.
constexpr double same_place = 1e-11;

/// Distance from the boundary, relative to the cell, beyond which a piece's end is no corner of it.
constexpr double on_boundary = 1e-8;

/// How much longer the way from a to b becomes through x.
double detour(const Point<2>& a, const Point<2>& x, const Point<2>& b) {
  return (x - a).norm() + (b - x).norm() - (b - a).norm();
}

/// The place to insert x into a way so that it becomes longer by as little as possible, with the
/// length added.
std::pair<std::size_t, double> cheapest_place(const std::vector<Point<2>>& way, const Point<2>& x) {
  std::pair<std::size_t, double> best{1, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double added = detour(way[i - 1], x, way[i]);
    if (added < best.second) best = {i, added};
  }
  return best;
}

}  // namespace

std::vector<Point<2>> boundary_corners(const PointCloud<2>& cloud, const Domain<2>& domain) {
  std::vector<Point<2>> corners;
  for (const BoundaryPiece<2>& piece : domain.pieces()) {
    for (double end : {0.0, 1.0}) {
      corners.push_back(piece.map(BoundaryPiece<2>::Parameter(end)));
    }
  }
  for (int i = 0; i < cloud.size(); ++i) {
    if (cloud.marks_of(i).size() > 1) corners.emplace_back(cloud.nodes.col(i));
  }
  return corners;
}

CellOutline::CellOutline(const PointCloud<2>& cloud, const Domain<2>& domain,
                         const std::vector<Point<2>>& corners, int gauss)
    : cloud_(cloud),
      domain_(domain),
      corners_(corners),
      face_rule_(gauss_legendre(gauss)),
      arc_(domain, gauss) {}

double CellOutline::add(int node, const ConvexCell<2>& polygon, std::vector<FacePoint<2>>& points) {
  node_ = node;
  centre_ = cloud_.nodes.col(node);
  polygon_ = &polygon;
  radius_ = std::sqrt(farthest_squared(polygon));
  const std::vector<Point<2>>& corners = polygon.vertices();
  if (-domain_.distance(centre_) > radius_) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::size_t next = i + 1 == corners.size() ? 0 : i + 1;
      add_face(corners[i], corners[next], polygon.label(static_cast<int>(i)), points);
    }
    return radius_;
  }
  add_inner_faces(points);
  double farthest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (distances_[i] <= 0) farthest = std::max(farthest, corners[i].norm());
  }
  if (crossings_.empty()) return farthest;
  const std::size_t first = points.size();
  pair_crossings();
  put_corners_on_ways();
  add_boundary(points);
  for (const std::vector<Point<2>>& way : ways()) {
    for (const Point<2>& x : way) farthest = std::max(farthest, x.norm());
  }
  for (std::size_t i = first; i < points.size(); ++i) {
    farthest = std::max(farthest, (points[i].x - centre_).norm());
  }
  return farthest;
}

/// Adds the parts of the polygon inside the domain and collects the crossings between them.
void CellOutline::add_inner_faces(std::vector<FacePoint<2>>& points) {
  const std::vector<Point<2>>& corners = polygon_->vertices();
  distances_.clear();
  crossings_.clear();
  for (const Point<2>& corner : corners) distances_.push_back(distance(corner));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t next = i + 1 == corners.size() ? 0 : i + 1;
    const Point<2> from = centre_ + corners[i];
    const Point<2> to = centre_ + corners[next];
    find_crossings<2>(domain_, {from, to, distances_[i], distances_[next]}, resolution * radius_,
                      parameters_);
    Point<2> start = corners[i];
    bool is_inside = distances_[i] <= 0;
    for (double t : parameters_) {
      const Point<2> x = corners[i] + t * (corners[next] - corners[i]);
      if (is_inside) add_face(start, x, polygon_->label(static_cast<int>(i)), points);
      crossings_.push_back({x, is_inside, false});
      start = x;
      is_inside = !is_inside;
    }
    if (is_inside) add_face(start, corners[next], polygon_->label(static_cast<int>(i)), points);
  }
}

void CellOutline::add_face(const Point<2>& from, const Point<2>& to, int neighbour,
                           std::vector<FacePoint<2>>& points) const {
  const Point<2> along = to - from;
  if (along.norm() <= same_place * same_place * radius_) return;
  for (int i = 0; i < face_rule_.size(); ++i) {
    points.push_back({centre_ + from + face_rule_.at[i] * along,
                      face_rule_.weight[i] * Point<2>(along[1], -along[0]), -1, neighbour});
  }
}

/// Finds where each stretch of the boundary that begins at a crossing ends. Stretches do not cross.
/// Of several, those come first whose ends point at each other.
void CellOutline::pair_crossings() {
  const int count = static_cast<int>(crossings_.size());
  candidates_.clear();
  stretches_.clear();
  for (int leaves = 0; leaves < count; ++leaves) {
    for (int enters = 0; enters < count; ++enters) {
      if (crossings_[leaves].leaves && !crossings_[enters].leaves) add_candidate(leaves, enters);
    }
  }
  std::sort(candidates_.begin(), candidates_.end(), [](const Stretch& a, const Stretch& b) {
    return std::tuple(-a.score, a.leaves, a.enters) < std::tuple(-b.score, b.leaves, b.enters);
  });
  for (const Stretch& candidate : candidates_) {
    if (!fits(candidate)) continue;
    crossings_[candidate.leaves].is_paired = true;
    crossings_[candidate.enters].is_paired = true;
    stretches_.push_back(candidate);
    if (ways_.size() < stretches_.size()) ways_.emplace_back();
    ways_[stretches_.size() - 1].assign(
        {crossings_[candidate.leaves].x, crossings_[candidate.enters].x});
  }
}

void CellOutline::add_candidate(int leaves, int enters) {
  Stretch candidate{leaves, enters, 0};
  const Point<2> chord = crossings_[enters].x - crossings_[leaves].x;
  const double length = chord.norm();
  if (length <= same_place * radius_) {
    candidate.score = 2;
  } else if (crossings_.size() > 2) {
    candidate.score =
        (way_along_boundary(crossings_[leaves].x) + way_along_boundary(crossings_[enters].x))
            .dot(chord) /
        length;
  }
  candidates_.push_back(candidate);
}

/// Unit tangent of the boundary with the domain to its left.
Point<2> CellOutline::way_along_boundary(const Point<2>& x) const {
  constexpr double step = 1e-6;  // of the cell: central differences lose a third of the digits
  const Point<2> out = distance_gradient<2>(domain_, centre_ + x, step * radius_).normalized();
  return {-out[1], out[0]};
}

/// Whether both ends are free and no stretch already chosen separates them.
bool CellOutline::fits(const Stretch& candidate) const {
  if (crossings_[candidate.leaves].is_paired || crossings_[candidate.enters].is_paired) {
    return false;
  }
  const auto [low, high] = std::minmax(candidate.leaves, candidate.enters);
  return std::all_of(stretches_.begin(), stretches_.end(), [&](const Stretch& other) {
    const bool first = other.leaves > low && other.leaves < high;
    const bool second = other.enters > low && other.enters < high;
    return first == second;
  });
}

/// Puts the corners inside the polygon on the way that they lengthen least.
void CellOutline::put_corners_on_ways() {
  for (const Point<2>& corner : corners_) {
    const Point<2> x = corner - centre_;
    if (!holds(x)) continue;
    std::vector<Point<2>>* best = nullptr;
    std::pair<std::size_t, double> best_place{0, std::numeric_limits<double>::infinity()};
    bool is_known = false;
    for (std::vector<Point<2>>& way : ways()) {
      for (const Point<2>& other : way) {
        is_known = is_known || (other - x).norm() <= same_place * radius_;
      }
      const auto place = cheapest_place(way, x);
      if (place.second >= best_place.second) continue;
      best_place = place;
      best = &way;
    }
    if (is_known || best == nullptr) continue;
    best->insert(best->begin() + static_cast<std::ptrdiff_t>(best_place.first), x);
  }
}

/// Whether a corner lies inside the polygon and on the boundary.
bool CellOutline::holds(const Point<2>& corner) const {
  if (corner.squaredNorm() > radius_ * radius_) return false;
  const std::vector<Point<2>>& corners = polygon_->vertices();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point<2>& from = corners[i];
    const Point<2> along = corners[i + 1 == corners.size() ? 0 : i + 1] - from;
    const Point<2> arm = corner - from;
    if (along[0] * arm[1] - along[1] * arm[0] < 0) return false;
  }
  return std::abs(distance(corner)) <= on_boundary * radius_;
}

void CellOutline::add_boundary(std::vector<FacePoint<2>>& points) {
  arc_.set_centre(centre_);
  const SideFinder finder{cloud_, domain_, node_, *polygon_};
  const std::size_t first = points.size();
  for (const std::vector<Point<2>>& way : ways()) {
    for (std::size_t i = 1; i < way.size(); ++i) arc_.trace(way[i - 1], way[i], points);
  }
  for (std::size_t i = first; i < points.size(); ++i) {
    points[i].side = finder.side_at(points[i].x, points[i].area.normalized());
  }
}

}  // namespace strongpoint
