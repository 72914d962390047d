#include "problems/core/curved_cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "problems/core/line_crossings.hpp"

namespace strongpoint {
namespace {

/// Features of the side smaller than this fraction of a cell may be missed on its edges.
constexpr double resolution = 1.0 / 16;

/// Lengths below this fraction of the cell are round-off.
constexpr double tiny_length = 1e-12;

/// Cosine of the steepest slope of a patch above its shadow.
constexpr double steepest = 0.3;

/// What may be left of the sum of area vectors, relative to the patch, before it is taken back.
constexpr double most_left = 0.05;

}  // namespace

CurvedCell::CurvedCell(const Domain<3>& domain, const PolygonRule& rule)
    : domain_(domain), rule_(rule), curve_rule_(gauss_legendre(curve_points)) {}

std::optional<double> CurvedCell::add(const ConvexCell<3>& polyhedron, const Point<3>& centre,
                                      int side, std::vector<FacePoint<3>>& points) {
  polyhedron_ = &polyhedron;
  centre_ = centre;
  side_ = side;
  radius_ = std::sqrt(farthest_squared(polyhedron));
  const std::size_t first = points.size();
  find_edge_crossings();
  bool is_followed = true;
  curves_.clear();
  for (int face = 0; face < polyhedron.face_count() && is_followed; ++face) {
    is_followed = add_face(face, points);
  }
  const std::size_t first_of_patches = points.size();
  while (is_followed && next_loop()) is_followed = add_patch(points);
  is_followed = is_followed && close(first, first_of_patches, points);
  if (!is_followed) {
    points.resize(first);
    return std::nullopt;
  }
  for (std::size_t i = first; i < points.size(); ++i) points[i].x += centre;
  double farthest = 0;
  for (std::size_t v = 0; v < distances_.size(); ++v) {
    if (distances_[v] <= inside_) {
      farthest = std::max(farthest, polyhedron.vertices()[v].squaredNorm());
    }
  }
  for (const Crossing& crossing : crossings_) {
    farthest = std::max(farthest, crossing.x.squaredNorm());
  }
  return std::sqrt(farthest);
}

void CurvedCell::find_edge_crossings() {
  const std::vector<Point<3>>& vertices = polyhedron_->vertices();
  // Distances on a flat side are 0 but for round-off: such vertices count as inside.
  inside_ = tiny_length * radius_ +
            64 * std::numeric_limits<double>::epsilon() * centre_.cwiseAbs().maxCoeff();
  distances_.clear();
  crossings_.clear();
  for (const Point<3>& v : vertices) distances_.push_back(distance(v));
  for (int face = 0; face < polyhedron_->face_count(); ++face) {
    const std::span<const int> loop = polyhedron_->face(face);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int low = loop[i];
      const int high = loop[i + 1 == loop.size() ? 0 : i + 1];
      if (low > high) continue;  // the face beyond runs the other way
      find_crossings<3>(domain_,
                        {centre_ + vertices[low], centre_ + vertices[high], distances_[low],
                         distances_[high], inside_},
                        resolution * radius_, parameters_);
      for (double t : parameters_) {
        crossings_.push_back({low, high, t, vertices[low] + t * (vertices[high] - vertices[low])});
      }
    }
  }
}

/// Appends the crossings of an edge in the direction it is walked.
void CurvedCell::walk_edge(int from, int to, std::vector<int>& ends) {
  const int low = std::min(from, to);
  const int high = std::max(from, to);
  const auto first = static_cast<std::ptrdiff_t>(ends.size());
  for (int i = 0; i < static_cast<int>(crossings_.size()); ++i) {
    if (crossings_[i].low == low && crossings_[i].high == high) ends.push_back(i);
  }
  if (from > to) std::reverse(ends.begin() + first, ends.end());
}

/// Appends the points of a face inside the domain; false when its curves cannot be followed.
bool CurvedCell::add_face(int face, std::vector<FacePoint<3>>& points) {
  const std::span<const int> loop = polyhedron_->face(face);
  const std::vector<Point<3>>& vertices = polyhedron_->vertices();
  corners_.clear();
  ends_.clear();
  Point<3> normal = Point<3>::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const int from = loop[i];
    const int to = loop[i + 1 == loop.size() ? 0 : i + 1];
    normal += (vertices[from] - vertices[loop[0]]).cross(vertices[to] - vertices[loop[0]]);
    if (distances_[from] <= inside_) corners_.push_back(vertices[from]);
    const std::size_t before = ends_.size();
    walk_edge(from, to, ends_);
    for (std::size_t k = before; k < ends_.size(); ++k) {
      corners_.push_back(crossings_[ends_[k]].x);
    }
  }
  const std::size_t first = points.size();
  if (corners_.size() > 2) rule_.add(corners_, points);
  bool is_followed = ends_.size() % 2 == 0;
  if (is_followed && !ends_.empty()) {
    normal.normalize();
    const std::size_t first_leaves = distances_[loop[0]] <= inside_ ? 0 : 1;
    for (std::size_t k = first_leaves; k < ends_.size() && is_followed; k += 2) {
      is_followed = add_curve(ends_[k], ends_[(k + 1) % ends_.size()], normal, points);
    }
  }
  set_label(polyhedron_->label(face), first, points);
  return is_followed;
}

/// Finds the heights of a curve above its chord and appends the points between the two.
bool CurvedCell::add_curve(int leaves, int enters, const Point<3>& normal,
                           std::vector<FacePoint<3>>& points) {
  const Point<3>& from = crossings_[leaves].x;
  const Point<3> along = crossings_[enters].x - from;
  const double length = along.norm();
  Curve curve{leaves, enters, Point<3>::Zero(), {}, false};
  if (length > tiny_length * radius_) {
    curve.out = along.cross(normal) / length;
    for (std::size_t k = 0; k < curve_points; ++k) {
      const Point<3> x = from + curve_rule_.at[k] * along;
      const std::optional<double> found = height(x, curve.out, length);
      if (!found) return false;
      curve.heights[k] = *found;
      const double area = *found * curve_rule_.weight[k] * length;
      if (std::abs(*found) <= tiny_length * length) continue;
      points.push_back({x + 0.5 * *found * curve.out, area * normal, -1, -1});
    }
  }
  curves_.push_back(curve);
  return true;
}

/// How far from x the side is, up to `reach` either way.
std::optional<double> CurvedCell::height(const Point<3>& x, const Point<3>& up, double reach) {
  return height_of_boundary<3>(domain_, centre_ + x, up, reach, inside_, parameters_);
}

/// Collects the curves around the next patch in order; false when there is none left.
bool CurvedCell::next_loop() {
  loop_.clear();
  const auto unused = [](const Curve& curve) { return !curve.is_used; };
  auto curve = std::find_if(curves_.begin(), curves_.end(), unused);
  while (curve != curves_.end()) {
    curve->is_used = true;
    loop_.push_back(static_cast<int>(curve - curves_.begin()));
    const int end = curve->leaves;  // a patch has its faces on the other side of the curve
    curve = std::find_if(curves_.begin(), curves_.end(),
                         [&](const Curve& c) { return !c.is_used && c.enters == end; });
  }
  return !loop_.empty();
}

/// Appends the points of the patch inside the loop; false when it is no graph above its shadow.
bool CurvedCell::add_patch(std::vector<FacePoint<3>>& points) {
  if (curves_[loop_.front()].enters != curves_[loop_.back()].leaves) return false;
  Point<3> middle = Point<3>::Zero();
  for (int i : loop_) middle += crossings_[curves_[i].leaves].x;
  middle /= static_cast<double>(loop_.size());
  Point<3> up = domain_.normal(side_, centre_ + middle);
  const std::optional<double> top = height(middle, up, radius_);
  if (!top) return false;
  const Point<3> apex = middle + *top * up;
  up = domain_.normal(side_, centre_ + apex);
  shadow_.clear();
  for (int i : loop_) {
    const Curve& curve = curves_[i];
    const Point<3>& from = crossings_[curve.leaves].x;
    const Point<3>& to = crossings_[curve.enters].x;
    corners_ = {apex, to, from};
    rule_.add(corners_, shadow_);
    const double turn = (to - from).cross(curve.out).dot(up);
    for (std::size_t k = 0; k < curve_points; ++k) {
      const Point<3> x =
          from + curve_rule_.at[k] * (to - from) + 0.5 * curve.heights[k] * curve.out;
      const double area = curve.heights[k] * curve_rule_.weight[k] * turn;
      if (area != 0) shadow_.push_back({x, area * up, -1, -1});
    }
  }
  return raise_shadow(up, points);
}

/// Moves points along `up` onto the side, where their areas have the side's normals and the same
/// shadow.
bool CurvedCell::raise_shadow(const Point<3>& up, std::vector<FacePoint<3>>& points) {
  for (const FacePoint<3>& point : shadow_) {
    const std::optional<double> found = height(point.x, up, radius_);
    if (!found) return false;
    const Point<3> x = point.x + *found * up;
    const Point<3> normal = domain_.normal(side_, centre_ + x);
    const double cosine = normal.dot(up);
    if (!(cosine > steepest)) return false;
    points.push_back({x, point.area.dot(up) / cosine * normal, side_, -1});
  }
  return true;
}

/// Takes the sum of the area vectors back from the points of the patches; false when it is more
/// than the error of a rule.
bool CurvedCell::close(std::size_t first, std::size_t first_of_patches,
                       std::vector<FacePoint<3>>& points) {
  if (first_of_patches == points.size()) return curves_.empty();
  Point<3> left = Point<3>::Zero();
  double size = 0;
  for (std::size_t i = first; i < points.size(); ++i) {
    left += points[i].area;
    if (i >= first_of_patches) size += points[i].area.norm();
  }
  if (!(left.norm() <= most_left * size)) return false;
  for (std::size_t i = first_of_patches; i < points.size(); ++i) {
    points[i].area -= points[i].area.norm() / size * left;
  }
  return true;
}

}  // namespace strongpoint
