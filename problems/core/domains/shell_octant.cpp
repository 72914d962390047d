#include "problems/core/domains/shell_octant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/domains/octant_pieces.hpp"

namespace strongpoint {

using Point3 = Point<3>;

ShellOctant::ShellOctant(double a, double b) : a_(a), b_(b) {
  if (a > 0 && b > a) return;
  throw CaseError(
      fmt::format("shell with radii {} and {}: they must be positive, the second larger", a, b));
}

const std::vector<std::string>& ShellOctant::sides() const {
  static const std::vector<std::string> names{"inner", "outer", "x0", "y0", "z0"};
  return names;
}

double ShellOctant::measure() const { return std::numbers::pi / 6 * (b_ * b_ * b_ - a_ * a_ * a_); }

double ShellOctant::reference_length() const { return std::numbers::pi / 2 * a_; }

Point3 ShellOctant::map(const Point3&) const {
  throw SkipCase(
      "an octant of a shell has no regular structured map; use scattered, random or file");
}

Point3 ShellOctant::normal(int side, const Point3& x) const {
  if (side == inner) return -x.normalized();
  if (side == outer) return x.normalized();
  return -Point3::Unit(side - x0);
}

double ShellOctant::distance(const Point3& x) const {
  return std::max({a_ - x.norm(), x.norm() - b_, -x.minCoeff()});
}

std::vector<BoundaryPiece<3>> ShellOctant::pieces() const {
  const auto sphere = [](double radius) {
    return [radius](const Point3& q) -> Point3 { return radius / q.norm() * q; };
  };
  return octant_pieces(Point3::Ones(), sphere(a_), sphere(b_),
                       {inner, {outer, outer, outer}, {x0, y0, z0}});
}

double ShellOctant::spacing(const Point3& x, int level) const {
  return Domain<3>::spacing(x, level) * std::max(x.norm(), a_) / a_;
}

std::vector<Feature<3>> ShellOctant::features() const {
  const double a = a_, b = b_;
  std::vector<Feature<3>> result{
      {"inner", [a](const Point3& x) { return std::abs(x.norm() - a); }},
      {"outer", [b](const Point3& x) { return std::abs(x.norm() - b); }}};
  for (int c = 0; c < 3; ++c) {
    result.push_back({sides()[x0 + c], [c](const Point3& x) { return std::abs(x[c]); }});
  }
  return result;
}

}  // namespace strongpoint
