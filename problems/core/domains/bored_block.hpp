#pragma once

#include <string>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// One eighth of a block with a spherical bore: 0 < x < 5, 0 < y < 2.5, 0 < z < 3 outside the
/// sphere of radius 2 about the origin. Sides: bore; x0, y0, z0 on the planes of symmetry; right (x
/// = 5), back (y = 2.5), top (z = 3). Features: the sides, and `ligament`, the segment x = z = 0
/// from the bore to the back, where the block is thinnest.
class BoredBlock final : public Domain<3> {
 public:
  /// The sides, in their order.
  enum Side { bore, x0, y0, z0, right, back, top };
  static constexpr double length = 5;   ///< along x
  static constexpr double width = 2.5;  ///< along y
  static constexpr double height = 3;   ///< along z
  static constexpr double radius = 2;   ///< of the bore

  const std::vector<std::string>& sides() const override;
  double measure() const override;
  /// The edge of a cube of the same volume: level n then means about n^3 nodes.
  double reference_length() const override;
  /// Throws SkipCase: the block has no structured map.
  Point<3> map(const Point<3>& unit) const override;
  std::vector<int> sides_at(const Point<3>&) const override { return {}; }
  Point<3> normal(int side, const Point<3>& x) const override;
  /// Exact but for a point outside that is nearest to an edge, where it is too small.
  double distance(const Point<3>& x) const override;
  std::vector<BoundaryPiece<3>> pieces() const override;
  /// min(h0 + 0.05 d, 1.5 h0 + 0.05 (|x| - 2), 2.5 h0), h0 = 0.1 s(level), d the distance from the
  /// ligament; s makes level n mean about n^3 nodes.
  double spacing(const Point<3>& x, int level) const override;
  std::vector<Feature<3>> features() const override;
};

}  // namespace strongpoint
