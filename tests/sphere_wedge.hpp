#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// The part of the shell between radii 1 and 2 about the origin that is seen through a square: two
/// curved sides, one of them concave, and four flat ones at 30 degrees to the x axis.
class SphereWedge final : public Domain<3> {
 public:
  static constexpr double half_angle = M_PI / 6;
  static constexpr double inner = 1, outer = 2;
  /// Solid angle of a pyramid with a square base.
  static double solid_angle() {
    const double t = std::tan(half_angle);
    return 4 * std::asin(t * t / (1 + t * t));
  }

  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"inner", "outer", "right", "left", "back", "front"};
    return names;
  }
  double measure() const override {
    return solid_angle() * (std::pow(outer, 3) - std::pow(inner, 3)) / 3;
  }
  double reference_length() const override { return 1; }
  Point<3> map(const Point<3>& unit) const override {
    const double u = half_angle * (2 * unit[1] - 1);
    const double v = half_angle * (2 * unit[2] - 1);
    return (inner + (outer - inner) * unit[0]) * Point<3>(1, std::tan(u), std::tan(v)).normalized();
  }
  std::vector<int> sides_at(const Point<3>& unit) const override {
    std::vector<int> found;
    for (int c = 0; c < 3; ++c) {
      if (unit[c] == 0) found.push_back(2 * c);
      if (unit[c] == 1) found.push_back(2 * c + 1);
    }
    return found;
  }
  Point<3> normal(int side, const Point<3>& x) const override {
    if (side < 2) return (side == 0 ? -1 : 1) * x.normalized();
    Point<3> n(-std::sin(half_angle), 0, 0);
    n[side < 4 ? 1 : 2] = (side % 2 == 0 ? -1 : 1) * std::cos(half_angle);
    return n;
  }
  double distance(const Point<3>& x) const override {
    double largest = std::max(inner - x.norm(), x.norm() - outer);
    for (int side = 2; side < 6; ++side) largest = std::max(largest, normal(side, x).dot(x));
    return largest;
  }
  std::vector<BoundaryPiece<3>> pieces() const override { return {}; }
};

}  // namespace strongpoint
