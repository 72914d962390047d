#include "problems/core/cell_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "problems/core/distance_gradient.hpp"
#include "problems/core/line_crossings.hpp"
#include "problems/core/side_finder.hpp"

namespace strongpoint {
namespace {

/// Features of the boundary smaller than this fraction of a cell may be missed on its faces.
constexpr double resolution = 1.0 / 64;

/// A way along the boundary went wrong where it is this far off, relative to the cell, or where its
/// normal and the side's have a smaller cosine; on a corner that nobody announced it is near both.
constexpr double off_boundary = 0.02;
constexpr double backwards = -0.5;

/// Corners nearer than this fraction of the cell to a crossing or to each other are one.
constexpr double same_place = 1e-11;

/// Corners of a way that are tried in every order.
constexpr std::size_t most_corners = 6;

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
  is_broken_ = false;
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
      crossings_.push_back({x, Point<2>::Zero(), is_inside});
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

/// Finds where each stretch of the boundary that begins at a crossing ends.
void CellOutline::pair_crossings() {
  if (crossings_.size() > 2) {
    for (BoundaryCrossing& crossing : crossings_) {
      crossing.along = way_along_boundary(crossing.x);
    }
  }
  pairs_.find(crossings_);
  const std::span<const Stretch> stretches = pairs_.stretches();
  if (ways_.size() < stretches.size()) ways_.resize(stretches.size());
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    ways_[i].assign({crossings_[stretches[i].leaves].x, crossings_[stretches[i].enters].x});
  }
}

/// Unit tangent of the boundary with the domain to its left.
Point<2> CellOutline::way_along_boundary(const Point<2>& x) const {
  constexpr double step = 1e-6;  // of the cell: central differences lose a third of the digits
  const Point<2> out = distance_gradient<2>(domain_, centre_ + x, step * radius_).normalized();
  return {-out[1], out[0]};
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
  for (std::vector<Point<2>>& way : ways()) put_in_order(way);
}

/// Puts the corners of a way in the order in which the boundary visits them, where the shortest way
/// does not.
void CellOutline::put_in_order(std::vector<Point<2>>& way) const {
  if (way.size() < 4 || way.size() > most_corners + 2) return;
  double least = misfit(way);
  if (least <= on_boundary * radius_) return;
  std::vector<Point<2>> other = way;
  const auto by_place = [](const Point<2>& a, const Point<2>& b) {
    return std::pair(a[0], a[1]) < std::pair(b[0], b[1]);
  };
  std::sort(other.begin() + 1, other.end() - 1, by_place);
  do {
    const double its_misfit = misfit(other);
    if (its_misfit >= least) continue;
    least = its_misfit;
    way = other;
  } while (std::next_permutation(other.begin() + 1, other.end() - 1, by_place));
}

/// How far a way's chords are from the boundary, in all; those that run against it count whole.
double CellOutline::misfit(const std::vector<Point<2>>& way) const {
  double sum = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Point<2> along = way[i] - way[i - 1];
    const Point<2> normal(along[1], -along[0]);
    double off = 0;
    for (double t : {0.25, 0.5, 0.75}) {
      off = std::max(off, std::abs(distance(way[i - 1] + t * along)));
    }
    const Point<2> middle = way[i - 1] + 0.5 * along;
    constexpr double step = 1e-6;  // of the chord
    const bool leaves = distance(middle + step * normal) > distance(middle - step * normal);
    sum += leaves ? off : off + along.norm();
  }
  return sum;
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
    FacePoint<2>& point = points[i];
    const Point<2> normal = point.area.normalized();
    point.side = finder.side_at(point.x, normal);
    const double cosine = domain_.normal(point.side, point.x).dot(normal);
    const double off = std::abs(domain_.distance(point.x));
    if (!(cosine > backwards && off <= off_boundary * radius_)) is_broken_ = true;
  }
}

}  // namespace strongpoint
