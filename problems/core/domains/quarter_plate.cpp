#include "problems/core/domains/quarter_plate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "problems/core/domains/quarter_annulus.hpp"

namespace strongpoint {

using Point2 = Point<2>;

const std::vector<std::string>& QuarterPlate::sides() const {
  static const std::vector<std::string> names{"hole", "bottom", "right", "top", "left"};
  return names;
}

double QuarterPlate::measure() const { return 1 - std::numbers::pi / 4 * a_ * a_; }

Point2 QuarterPlate::map(const Point2& unit) const {
  const Point2 ray = quarter_turn(unit[0]);
  if (map_ == Map::log) {
    const double outer = 1 / ray.maxCoeff();
    return a_ * std::pow(outer / a_, unit[1]) * ray;
  }
  const Point2 outer(std::min(1.0, 2 - 2 * unit[0]), std::min(1.0, 2 * unit[0]));
  return (1 - unit[1]) * a_ * ray + unit[1] * outer;
}

std::vector<int> QuarterPlate::sides_at(const Point2& unit) const {
  constexpr double half_tolerance = 1e-12;  // round-off of i / (n-1)
  std::vector<int> result;
  if (unit[1] == 0) result.push_back(hole);
  if (unit[0] == 0) result.push_back(bottom);
  if (unit[1] == 1 && unit[0] <= 0.5 + half_tolerance) result.push_back(right);
  if (unit[1] == 1 && unit[0] >= 0.5 - half_tolerance) result.push_back(top);
  if (unit[0] == 1) result.push_back(left);
  return result;
}

Point2 QuarterPlate::normal(int side, const Point2& x) const {
  switch (side) {
    case hole:
      return -x.normalized();
    case bottom:
      return {0, -1};
    case right:
      return {1, 0};
    case top:
      return {0, 1};
    default:
      return {-1, 0};
  }
}

double QuarterPlate::distance(const Point2& x) const {
  return std::max({a_ - x.norm(), x[0] - 1, x[1] - 1, -x[0], -x[1]});
}

std::vector<BoundaryPiece<2>> QuarterPlate::pieces() const {
  using Parameter = BoundaryPiece<2>::Parameter;
  const double a = a_;
  return {{hole, [a](const Parameter& t) -> Point2 { return a * quarter_turn(t[0]); }},
          {bottom, [a](const Parameter& t) { return Point2(a + (1 - a) * t[0], 0); }},
          {right, [](const Parameter& t) { return Point2(1, t[0]); }},
          {top, [](const Parameter& t) { return Point2(t[0], 1); }},
          {left, [a](const Parameter& t) { return Point2(0, a + (1 - a) * t[0]); }}};
}

std::vector<Block<2>> QuarterPlate::blocks() const {
  const auto half = [this](int which) {
    return
        [this, which](const Point2& unit) { return map(Point2((which + unit[0]) / 2, unit[1])); };
  };
  return {{half(0), {bottom, interface_side, hole, right}},
          {half(1), {interface_side, left, hole, top}}};
}

double QuarterPlate::spacing(const Point2& x, int level) const {
  const double ratio = std::max(x.norm(), a_) / a_;
  // The usual powers, sooner.
  const double grown = growth_ == 1     ? ratio
                       : growth_ == 1.5 ? ratio * std::sqrt(ratio)
                                        : std::pow(ratio, growth_);
  return std::numbers::pi / 2 / (level - 1) * a_ * grown;
}

std::vector<Feature<2>> QuarterPlate::features() const {
  const double a = a_;
  const auto corners = [a](const Point2& x) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Point2& corner :
         {Point2(a, 0), Point2(1, 0), Point2(1, 1), Point2(0, 1), Point2(0, a)}) {
      nearest = std::min(nearest, (x - corner).norm());
    }
    return nearest;
  };
  return {{"hole", [a](const Point2& x) { return std::abs(x.norm() - a); }},
          {"bottom", [](const Point2& x) { return std::abs(x[1]); }},
          {"right", [](const Point2& x) { return std::abs(x[0] - 1); }},
          {"top", [](const Point2& x) { return std::abs(x[1] - 1); }},
          {"left", [](const Point2& x) { return std::abs(x[0]); }},
          {"corners", corners},
          {"notch", [a](const Point2& x) { return (x - Point2(0, a)).norm(); }}};
}

}  // namespace strongpoint
