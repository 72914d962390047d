#pragma once

#include <string>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// The octant a < |x| < b, x, y, z > 0 of a spherical shell, with sides inner, outer, and x0, y0,
/// z0 on the coordinate planes. A level counts nodes along a quarter of the inner sphere's equator;
/// scattered spacings are proportional to |x|. Features: the sides.
class ShellOctant final : public Domain<3> {
 public:
  /// The sides, in their order.
  enum Side { inner, outer, x0, y0, z0 };

  /// Takes 0 < a < b. Throws CaseError for other radii.
  ShellOctant(double a, double b);

  const std::vector<std::string>& sides() const override;
  double measure() const override;
  double reference_length() const override;
  /// Throws SkipCase: a map of the cube onto an octant has a singular edge.
  Point<3> map(const Point<3>& unit) const override;
  std::vector<int> sides_at(const Point<3>&) const override { return {}; }
  Point<3> normal(int side, const Point<3>& x) const override;
  /// Exact but for a point outside that is nearest to an edge, where it is too small.
  double distance(const Point<3>& x) const override;
  std::vector<BoundaryPiece<3>> pieces() const override;
  double spacing(const Point<3>& x, int level) const override;
  std::vector<Feature<3>> features() const override;

 private:
  double a_, b_;
};

}  // namespace strongpoint
