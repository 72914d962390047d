#include "problems/core/domains/bored_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/core/error.hpp"
#include "problems/core/domains/octant_pieces.hpp"

namespace strongpoint {
namespace {

using Point3 = Point<3>;

/// Factor of all spacings at a level, fitted so that level n gives n^3 nodes within 7 % from 15 to
/// 48 (measured with `scattered`).
double scale_of(int level) { return 22.8 / std::pow(level - 1, 1.133); }

/// Distance from the segment between (0, radius, 0) and (0, width, 0).
double ligament_distance(const Point3& x) {
  const double y = std::clamp(x[1], BoredBlock::radius, BoredBlock::width);
  return (x - Point3(0, y, 0)).norm();
}

}  // namespace

const std::vector<std::string>& BoredBlock::sides() const {
  static const std::vector<std::string> names{"bore", "x0", "y0", "z0", "right", "back", "top"};
  return names;
}

double BoredBlock::measure() const {
  return length * width * height - std::numbers::pi / 6 * radius * radius * radius;
}

double BoredBlock::reference_length() const { return std::cbrt(measure()); }

Point3 BoredBlock::map(const Point3&) const {
  throw SkipCase("a block with a bore has no structured map; use scattered, random or file");
}

Point3 BoredBlock::normal(int side, const Point3& x) const {
  if (side == bore) return -x.normalized();
  return side < right ? Point3(-Point3::Unit(side - x0)) : Point3(Point3::Unit(side - right));
}

double BoredBlock::distance(const Point3& x) const {
  const double beyond = (x - Point3(length, width, height)).maxCoeff();
  return std::max({radius - x.norm(), beyond, -x.minCoeff()});
}

std::vector<BoundaryPiece<3>> BoredBlock::pieces() const {
  return octant_pieces(
      {length, width, height}, [](const Point3& q) -> Point3 { return radius / q.norm() * q; },
      [](const Point3& q) { return q; }, {bore, {right, back, top}, {x0, y0, z0}});
}

double BoredBlock::spacing(const Point3& x, int level) const {
  // Factors of the recipe this cloud follows.
  constexpr double growth = 0.05;
  const double h0 = 0.1 * scale_of(level);
  const double at_bore = 1.5 * h0 + growth * std::max(x.norm() - radius, 0.0);
  return std::min({h0 + growth * ligament_distance(x), at_bore, 2.5 * h0});
}

std::vector<Feature<3>> BoredBlock::features() const {
  std::vector<Feature<3>> result{
      {"bore", [](const Point3& x) { return std::abs(x.norm() - radius); }}};
  const Point3 corner(length, width, height);
  for (int c = 0; c < 3; ++c) {
    result.push_back({sides()[x0 + c], [c](const Point3& x) { return std::abs(x[c]); }});
  }
  for (int c = 0; c < 3; ++c) {
    const double face = corner[c];
    result.push_back(
        {sides()[right + c], [c, face](const Point3& x) { return std::abs(x[c] - face); }});
  }
  result.push_back({"ligament", ligament_distance});
  return result;
}

}  // namespace strongpoint
