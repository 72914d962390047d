#include "problems/core/domains/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

/// Distances below this fraction of the reference length are round-off.
constexpr double round_off = 1e-12;

/// a x b.
double cross(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }

double segment_distance(const Point2& a, const Point2& b, const Point2& x) {
  const Point2 along = b - a;
  const double t = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (x - a - t * along).norm();
}

/// Whether two segments have a point in common.
bool meet(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const double c_side = cross(b - a, c - a);
  const double d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c);
  const double b_side = cross(d - c, b - c);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  // Otherwise they meet only where an end of one lies on the other.
  return segment_distance(a, b, c) == 0 || segment_distance(a, b, d) == 0 ||
         segment_distance(c, d, a) == 0 || segment_distance(c, d, b) == 0;
}

}  // namespace

Polygon::Polygon(std::vector<Point2> corners, const std::vector<std::string>& edge_sides,
                 double reference_length, Grading at_corners)
    : corners_(std::move(corners)), reference_length_(reference_length), at_corners_(at_corners) {
  if (size() < 3 || edge_sides.size() != corners_.size()) {
    throw CaseError(
        fmt::format("a polygon with {} corners and {} names of edges; give at least 3 "
                    "corners and a name for the edge that starts at each",
                    size(), edge_sides.size()));
  }
  for (const std::string& name : edge_sides) {
    const auto known = std::find(sides_.begin(), sides_.end(), name);
    side_of_edge_.push_back(static_cast<int>(known - sides_.begin()));
    if (known == sides_.end()) sides_.push_back(name);
  }
  for (int i = 0; i < size(); ++i) twice_area_ += cross(corner(i), corner(i + 1));
  check_simple();
}

/// Sine-like measure of the turn at a corner, positive for a turn to the left.
double Polygon::turn_at(int i) const {
  return cross(corner(i) - corner(i + size() - 1), corner(i + 1) - corner(i));
}

void Polygon::check_simple() const {
  const auto fail = [&](int i, int j) {
    throw CaseError(
        fmt::format("edges {} and {} of the polygon meet or fall on each other; its "
                    "edges may share corners with their neighbours only",
                    i + 1, j + 1));
  };
  for (int i = 0; i < size(); ++i) {
    const Point2 in = corner(i + 1) - corner(i);
    const Point2 out = corner(i + 2) - corner(i + 1);
    const bool folds_back = cross(in, out) == 0 && in.dot(out) <= 0;
    if (folds_back) fail(i, (i + 1) % size());
    for (int j = i + 2; j < size(); ++j) {
      if (i == 0 && j == size() - 1) continue;  // neighbours
      if (meet(corner(i), corner(i + 1), corner(j), corner(j + 1))) fail(i, j);
    }
  }
}

double Polygon::measure() const { return 0.5 * std::abs(twice_area_); }

Point2 Polygon::map(const Point2& unit) const {
  bool is_convex = true;
  for (int i = 0; i < size(); ++i) is_convex = is_convex && turn_at(i) * twice_area_ > 0;
  if (size() != 4 || !is_convex) {
    throw SkipCase(
        fmt::format("a polygon with {} corners{} has no structured map; use scattered, "
                    "random or file",
                    size(), is_convex ? "" : ", not convex,"));
  }
  const double s = unit[0];
  const double t = unit[1];
  return corners_[0] + s * (corners_[1] - corners_[0]) +
         t * ((1 - s) * (corners_[3] - corners_[0]) + s * (corners_[2] - corners_[1]));
}

std::vector<int> Polygon::sides_at(const Point2& unit) const {
  std::vector<int> found;
  if (unit[1] == 0) found.push_back(side_of_edge_[0]);
  if (unit[0] == 1) found.push_back(side_of_edge_[1]);
  if (unit[1] == 1) found.push_back(side_of_edge_[2]);
  if (unit[0] == 0) found.push_back(side_of_edge_[3]);
  return found;
}

double Polygon::edge_distance(int edge, const Point2& x) const {
  return segment_distance(corner(edge), corner(edge + 1), x);
}

double Polygon::corner_distance(const Point2& x) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Point2& c : corners_) nearest = std::min(nearest, (x - c).norm());
  return nearest;
}

Point2 Polygon::edge_normal(int edge) const {
  const Point2 along = (corner(edge + 1) - corner(edge)).normalized();
  const double outwards = twice_area_ > 0 ? 1 : -1;
  return outwards * Point2(along[1], -along[0]);
}

Point2 Polygon::normal(int side, const Point2& x) const {
  double nearest = std::numeric_limits<double>::infinity();
  Point2 at_nearest = Point2::Zero();
  Point2 touching = Point2::Zero();
  for (int edge = 0; edge < size(); ++edge) {
    if (side_of_edge_[edge] != side) continue;
    const double distance = edge_distance(edge, x);
    if (distance <= round_off * reference_length_) touching += edge_normal(edge);
    if (!(distance < nearest)) continue;
    nearest = distance;
    at_nearest = edge_normal(edge);
  }
  return touching.norm() > 0 ? touching.normalized() : at_nearest;
}

double Polygon::distance(const Point2& x) const {
  double nearest = std::numeric_limits<double>::infinity();
  bool is_inside = false;
  for (int edge = 0; edge < size(); ++edge) {
    const Point2& a = corner(edge);
    const Point2& b = corner(edge + 1);
    nearest = std::min(nearest, segment_distance(a, b, x));
    // A ray to the right crosses the boundary an odd number of times from inside.
    const bool spans = (a[1] > x[1]) != (b[1] > x[1]);
    if (spans && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) {
      is_inside = !is_inside;
    }
  }
  return is_inside ? -nearest : nearest;
}

std::vector<BoundaryPiece<2>> Polygon::pieces() const {
  std::vector<BoundaryPiece<2>> result;
  result.reserve(corners_.size());
  for (int edge = 0; edge < size(); ++edge) {
    result.push_back(
        {side_of_edge_[edge],
         [a = corner(edge), b = corner(edge + 1)](const BoundaryPiece<2>::Parameter& t) -> Point2 {
           return (1 - t[0]) * a + t[0] * b;
         }});
  }
  return result;
}

double Polygon::spacing(const Point2& x, int level) const {
  return Domain<2>::spacing(x, level) * at_corners_.factor(corner_distance(x));
}

std::vector<Feature<2>> Polygon::features() const {
  std::vector<Feature<2>> result;
  result.reserve(sides_.size() + corners_.size() + 1);
  for (int side = 0; side < static_cast<int>(sides_.size()); ++side) {
    result.push_back({sides_[side], [this, side](const Point2& x) {
                        double nearest = std::numeric_limits<double>::infinity();
                        for (int edge = 0; edge < size(); ++edge) {
                          if (side_of_edge_[edge] == side) {
                            nearest = std::min(nearest, edge_distance(edge, x));
                          }
                        }
                        return nearest;
                      }});
  }
  result.push_back({"corners", [this](const Point2& x) { return corner_distance(x); }});
  for (int i = 0; i < size(); ++i) {
    result.push_back({fmt::format("corner{}", i + 1),
                      [c = corner(i)](const Point2& x) { return (x - c).norm(); }});
  }
  return result;
}

}  // namespace strongpoint
