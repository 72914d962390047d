#pragma once

#include <string>
#include <vector>

#include "problems/core/domain.hpp"
#include "problems/core/grading.hpp"

namespace strongpoint {

/// A simple polygon; re-entrant corners are allowed. Edge i runs from corner i to the next one and
/// belongs to the side named for it; edges may share a side. Corners may run either way round.
/// Features: every side, `corners` (all), and `corner1`, `corner2`, ... one by one.
class Polygon final : public Domain<2> {
 public:
  /// Takes corners, the name of each edge's side, the length along which a level counts nodes, and
  /// how the spacing shrinks towards the corners. Throws CaseError unless the polygon is simple,
  /// with as many names as corners.
  Polygon(std::vector<Point<2>> corners, const std::vector<std::string>& edge_sides,
          double reference_length, Grading at_corners = {});

  const std::vector<std::string>& sides() const override { return sides_; }
  double measure() const override;
  double reference_length() const override { return reference_length_; }
  /// The bilinear map of a convex quadrilateral: corner 1 is the image of (0,0), corner 2 of (1,0).
  /// Throws SkipCase for other polygons.
  Point<2> map(const Point<2>& unit) const override;
  std::vector<int> sides_at(const Point<2>& unit) const override;
  /// The mean normal at a corner between edges of the same side.
  Point<2> normal(int side, const Point<2>& x) const override;
  /// Exact everywhere.
  double distance(const Point<2>& x) const override;
  std::vector<BoundaryPiece<2>> pieces() const override;
  double spacing(const Point<2>& x, int level) const override;
  std::vector<Feature<2>> features() const override;

 private:
  std::vector<Point<2>> corners_;  ///< counter-clockwise or clockwise, as given
  std::vector<std::string> sides_;
  std::vector<int> side_of_edge_;
  double reference_length_;
  Grading at_corners_;
  double twice_area_ = 0;  ///< signed: positive when the corners run counter-clockwise

  int size() const { return static_cast<int>(corners_.size()); }
  const Point<2>& corner(int i) const { return corners_[i % size()]; }
  double edge_distance(int edge, const Point<2>& x) const;
  double corner_distance(const Point<2>& x) const;
  Point<2> edge_normal(int edge) const;
  double turn_at(int i) const;
  void check_simple() const;
};

}  // namespace strongpoint
