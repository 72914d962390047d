#include "problems/core/domains/quarter_annulus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {

using Point2 = Point<2>;

Point2 quarter_turn(double t) {
  if (t == 0) return {1, 0};
  if (t == 1) return {0, 1};
  const double angle = t * std::numbers::pi / 2;
  return {std::cos(angle), std::sin(angle)};
}

QuarterAnnulus::QuarterAnnulus(double a, double b, Radii radii) : a_(a), b_(b), radii_(radii) {
  if (a > 0 && b > a) return;
  throw CaseError(
      fmt::format("annulus with radii {} and {}: they must be positive, the second larger", a, b));
}

const std::vector<std::string>& QuarterAnnulus::sides() const {
  static const std::vector<std::string> names{"inner", "outer", "bottom", "left"};
  return names;
}

double QuarterAnnulus::measure() const { return std::numbers::pi / 4 * (b_ * b_ - a_ * a_); }

double QuarterAnnulus::reference_length() const {
  return radii_ == Radii::geometric ? std::numbers::pi / 2 * a_ : b_ - a_;
}

Point2 QuarterAnnulus::map(const Point2& unit) const {
  if (unit[1] == 1) return b_ * quarter_turn(unit[0]);
  const double r =
      radii_ == Radii::geometric ? a_ * std::pow(b_ / a_, unit[1]) : a_ + (b_ - a_) * unit[1];
  return r * quarter_turn(unit[0]);
}

std::vector<int> QuarterAnnulus::sides_at(const Point2& unit) const {
  std::vector<int> found;
  if (unit[1] == 0) found.push_back(inner);
  if (unit[1] == 1) found.push_back(outer);
  if (unit[0] == 0) found.push_back(bottom);
  if (unit[0] == 1) found.push_back(left);
  return found;
}

Point2 QuarterAnnulus::normal(int side, const Point2& x) const {
  switch (side) {
    case inner:
      return -x.normalized();
    case outer:
      return x.normalized();
    case bottom:
      return {0, -1};
    default:
      return {-1, 0};
  }
}

double QuarterAnnulus::distance(const Point2& x) const {
  return std::max({a_ - x.norm(), x.norm() - b_, -x[0], -x[1]});
}

std::vector<BoundaryPiece<2>> QuarterAnnulus::pieces() const {
  using Parameter = BoundaryPiece<2>::Parameter;
  const double a = a_, b = b_;
  const auto radius = [a, b](double t) { return (1 - t) * a + t * b; };
  return {{inner, [a](const Parameter& t) -> Point2 { return a * quarter_turn(t[0]); }},
          {outer, [b](const Parameter& t) -> Point2 { return b * quarter_turn(t[0]); }},
          {bottom, [radius](const Parameter& t) { return Point2(radius(t[0]), 0); }},
          {left, [radius](const Parameter& t) { return Point2(0, radius(t[0])); }}};
}

double QuarterAnnulus::spacing(const Point2& x, int level) const {
  const double h = Domain<2>::spacing(x, level);
  return radii_ == Radii::geometric ? h * std::max(x.norm(), a_) / a_ : h;
}

std::vector<Feature<2>> QuarterAnnulus::features() const {
  const double a = a_, b = b_;
  return {{"inner", [a](const Point2& x) { return std::abs(x.norm() - a); }},
          {"outer", [b](const Point2& x) { return std::abs(x.norm() - b); }},
          {"bottom", [](const Point2& x) { return std::abs(x[1]); }},
          {"left", [](const Point2& x) { return std::abs(x[0]); }},
          {"corners", [a, b](const Point2& x) {
             // Both corners of an axis, the nearer axis by symmetry.
             const Point2 folded(x.maxCoeff(), x.minCoeff());
             return std::min((folded - Point2(a, 0)).norm(), (folded - Point2(b, 0)).norm());
           }}};
}

}  // namespace strongpoint
