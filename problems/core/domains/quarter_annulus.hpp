#pragma once

#include <string>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// How radii follow each other from the inner arc to the outer.
enum class Radii {
  geometric,  ///< r = a (b/a)^s; scattered spacings proportional to r: cells are isotropic
  uniform     ///< r = a + (b - a) s; scattered spacings constant
};

/// The quarter a < r < b, x > 0, y > 0 of an annulus with sides inner, outer, bottom (y = 0) and
/// left (x = 0). Unit coordinates are (angle over 90 degrees, position along the radius). A level
/// counts nodes along the inner arc when radii are geometric, along the radius when they are
/// uniform. Features: the sides, and `corners`.
class QuarterAnnulus final : public Domain<2> {
 public:
  /// The sides, in their order.
  enum Side { inner, outer, bottom, left };

  /// Takes 0 < a < b. Throws CaseError for other radii.
  QuarterAnnulus(double a, double b, Radii radii);

  const std::vector<std::string>& sides() const override;
  double measure() const override;
  double reference_length() const override;
  Point<2> map(const Point<2>& unit) const override;
  std::vector<int> sides_at(const Point<2>& unit) const override;
  Point<2> normal(int side, const Point<2>& x) const override;
  /// Exact but for a point outside that is nearest to a corner, where it is too small.
  double distance(const Point<2>& x) const override;
  std::vector<BoundaryPiece<2>> pieces() const override;
  double spacing(const Point<2>& x, int level) const override;
  std::vector<Feature<2>> features() const override;

 private:
  double a_, b_;
  Radii radii_;
};

/// Unit vector at t * 90 degrees from the x axis, exact at both ends.
Point<2> quarter_turn(double t);

}  // namespace strongpoint
