#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// A domain that only scattered clouds can fill.
class UnmappedDomain : public Domain<2> {
 public:
  Point<2> map(const Point<2>& unit) const override { return unit; }
  std::vector<int> sides_at(const Point<2>&) const override { return {}; }
};

/// Whether a domain tells its pieces, and with them its corners.
enum class Corners { told, secret };

/// A polygon given by its corners, counter-clockwise; every edge is a side, named by its number.
class PolygonDomain final : public UnmappedDomain {
 public:
  explicit PolygonDomain(std::vector<Point<2>> corners, Corners telling = Corners::told)
      : corners_(std::move(corners)), telling_(telling) {
    for (std::size_t i = 0; i < corners_.size(); ++i) names_.push_back(std::to_string(i));
  }

  const std::vector<std::string>& sides() const override { return names_; }
  double measure() const override {
    double twice = 0;
    for (int i = 0; i < count(); ++i) {
      twice += corner(i)[0] * corner(i + 1)[1] - corner(i)[1] * corner(i + 1)[0];
    }
    return twice / 2;
  }
  double reference_length() const override { return 1; }
  Point<2> normal(int side, const Point<2>&) const override {
    const Point<2> along = (corner(side + 1) - corner(side)).normalized();
    return {along[1], -along[0]};
  }
  double distance(const Point<2>& x) const override {
    double nearest = std::numeric_limits<double>::infinity();
    bool is_inside = false;
    for (int i = 0; i < count(); ++i) {
      const Point<2>& a = corner(i);
      const Point<2>& b = corner(i + 1);
      const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (x - a - t * (b - a)).norm());
      const bool spans = (a[1] > x[1]) != (b[1] > x[1]);
      if (spans && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) {
        is_inside = !is_inside;
      }
    }
    return is_inside ? -nearest : nearest;
  }
  std::vector<BoundaryPiece<2>> pieces() const override {
    std::vector<BoundaryPiece<2>> result;
    for (int i = 0; i < count() && telling_ == Corners::told; ++i) {
      const Point<2> a = corner(i), b = corner(i + 1);
      result.push_back({i, [a, b](const BoundaryPiece<2>::Parameter& t) -> Point<2> {
                          return t[0] == 1 ? b : Point<2>(a + t[0] * (b - a));
                        }});
    }
    return result;
  }

 private:
  std::vector<Point<2>> corners_;
  Corners telling_;
  std::vector<std::string> names_;

  int count() const { return static_cast<int>(corners_.size()); }
  const Point<2>& corner(int i) const { return corners_[i % count()]; }
};

/// [0,1]^2 without its upper right quarter.
inline PolygonDomain l_shape(Corners telling = Corners::told) {
  return PolygonDomain({{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}}, telling);
}

/// [0,1]^2 with a notch from above, 0.04 wide.
inline PolygonDomain notched_square() {
  return PolygonDomain(
      {{0, 0}, {1, 0}, {1, 1}, {0.52, 1}, {0.52, 0.4}, {0.48, 0.4}, {0.48, 1}, {0, 1}});
}

/// The ring between radii 0.4 and 1 about the origin: both of its sides are closed curves.
class RingDomain final : public UnmappedDomain {
 public:
  static constexpr double inner = 0.4, outer = 1;

  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"inner", "outer"};
    return names;
  }
  double measure() const override { return M_PI * (outer * outer - inner * inner); }
  double reference_length() const override { return 2; }
  Point<2> normal(int side, const Point<2>& x) const override {
    return (side == 0 ? -1 : 1) * x.normalized();
  }
  double distance(const Point<2>& x) const override {
    return std::max(inner - x.norm(), x.norm() - outer);
  }
  std::vector<BoundaryPiece<2>> pieces() const override {
    std::vector<BoundaryPiece<2>> result;
    for (int side : {0, 1}) {
      const double radius = side == 0 ? inner : outer;
      result.push_back({side, [radius](const BoundaryPiece<2>::Parameter& t) {
                          const double angle = t[0] == 1 ? 0 : 2 * M_PI * t[0];
                          return Point<2>(radius * std::cos(angle), radius * std::sin(angle));
                        }});
    }
    return result;
  }
};

}  // namespace strongpoint
