#pragma once

#include <string>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// [0,1]^2 without the disc r < a, with sides hole, bottom, right, top, left. Unit coordinates are
/// (angle over 90 degrees, position along the ray). Features: the sides, `corners`, and `notch`,
/// the point (0, a).
class QuarterPlate final : public Domain<2> {
 public:
  /// How a grid's nodes lie along a ray.
  enum class Map {
    log,  ///< r = a (R/a)^s: isotropic at the hole
    edge  ///< uniform, from the arc to points equidistant along the outer sides
  };
  /// The sides, in their order.
  enum Side { hole, bottom, right, top, left };

  /// Takes a radius 0 < a < 1 and the power of r by which the spacing of scattered nodes grows.
  QuarterPlate(double a, Map map, double growth = 1.5) : a_(a), map_(map), growth_(growth) {}

  const std::vector<std::string>& sides() const override;
  double measure() const override;
  double reference_length() const override { return 1; }
  Point<2> map(const Point<2>& unit) const override;
  std::vector<int> sides_at(const Point<2>& unit) const override;
  Point<2> normal(int side, const Point<2>& x) const override;
  /// Exact but for a point outside that is nearest to a corner, where it is too small.
  double distance(const Point<2>& x) const override;
  std::vector<BoundaryPiece<2>> pieces() const override;
  /// Two, split at 45 degrees, where the outer sides meet and the map has a kink.
  std::vector<Block<2>> blocks() const override;
  /// c a (r/a)^growth with c = (pi/2) / (n-1): n nodes on the arc.
  double spacing(const Point<2>& x, int level) const override;
  std::vector<Feature<2>> features() const override;

 private:
  double a_;
  Map map_;
  double growth_;
};

}  // namespace strongpoint
