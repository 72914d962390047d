#include "problems/core/polyhedron_faces.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "problems/core/cell_maker.hpp"

namespace strongpoint {
namespace {

/// The corner that triangles share: the same one from both sides of a face. The direction is that
/// of no lattice, so that corners do not tie.
std::size_t first_corner(const std::vector<Point<3>>& corners) {
  const Point<3> direction(0.5257311, 0.7071068, 0.4728709);
  const auto behind = [&](const Point<3>& a, const Point<3>& b) {
    return direction.dot(a) < direction.dot(b);
  };
  return static_cast<std::size_t>(std::min_element(corners.begin(), corners.end(), behind) -
                                  corners.begin());
}

}  // namespace

PolygonRule::PolygonRule(int gauss) {
  const auto add_orbit = [this](double one, double two, double weight) {
    places_.push_back({one, two, weight});
    places_.push_back({two, one, weight});
    places_.push_back({one, one, weight});
  };
  if (gauss == 2) {
    add_orbit(1.0 / 6, 2.0 / 3, 1.0 / 3);
  } else if (gauss == 3) {
    // The closed form of the rule of degree 4.
    const double root = std::sqrt(38 - 44 * std::sqrt(0.4));
    const double weight = std::sqrt(213125 - 53320 * std::sqrt(10.0));
    const double plus = (8 - std::sqrt(10.0) + root) / 18;
    const double minus = (8 - std::sqrt(10.0) - root) / 18;
    add_orbit(plus, 1 - 2 * plus, (620 + weight) / 3720);
    add_orbit(minus, 1 - 2 * minus, (620 - weight) / 3720);
  } else if (gauss == 4) {
    const LineRule line = gauss_legendre(4);
    for (int i = 0; i < line.size(); ++i) {
      for (int j = 0; j < line.size(); ++j) {
        const double r = line.at[i];
        const double share = 2 * r * line.weight[i] * line.weight[j];
        places_.push_back({r * (1 - line.at[j]), r * line.at[j], share});
      }
    }
  }
}

void PolygonRule::add(const std::vector<Point<3>>& corners,
                      std::vector<FacePoint<3>>& points) const {
  const std::size_t count = corners.size();
  const std::size_t first = first_corner(corners);
  const auto arm = [&](std::size_t i) -> Point<3> {
    const std::size_t at = first + i;
    return corners[at < count ? at : at - count] - corners[first];
  };
  Point<3> whole = Point<3>::Zero();
  for (std::size_t i = 2; i < count; ++i) whole += 0.5 * arm(i - 1).cross(arm(i));
  const double total = whole.norm();
  if (!(total > 0)) return;
  Point<3> moment = Point<3>::Zero();
  for (std::size_t i = 2; i < count; ++i) {
    const Point<3> a = arm(i - 1);
    const Point<3> b = arm(i);
    const Point<3> area = 0.5 * a.cross(b);
    moment += area.dot(whole) / total * (a + b) / 3;
    for (const Place& place : places_) {
      points.push_back(
          {corners[first] + place.second * a + place.third * b, place.weight * area, -1, -1});
    }
  }
  if (places_.empty()) points.push_back({corners[first] + moment / total, whole, -1, -1});
}

void set_label(int label, std::size_t first, std::vector<FacePoint<3>>& points) {
  for (std::size_t i = first; i < points.size(); ++i) {
    points[i].side = side_of_label(label);
    points[i].neighbour = std::max(label, -1);
  }
}

void add_ends(const ConvexCell<1>& cell, const Point<1>& centre,
              std::vector<FacePoint<1>>& points) {
  for (int end = 0; end < static_cast<int>(cell.vertices().size()); ++end) {
    const int label = cell.label(end);
    points.push_back({centre + cell.vertices()[end], Point<1>(end == 0 ? -1 : 1),
                      side_of_label(label), std::max(label, -1)});
  }
}

void add_faces(const ConvexCell<3>& cell, const Point<3>& centre, const PolygonRule& rule,
               std::vector<Point<3>>& corners, std::vector<FacePoint<3>>& points) {
  for (int face = 0; face < cell.face_count(); ++face) {
    corners.clear();
    for (int v : cell.face(face)) corners.emplace_back(centre + cell.vertices()[v]);
    const std::size_t first = points.size();
    rule.add(corners, points);
    set_label(cell.label(face), first, points);
  }
}

}  // namespace strongpoint
