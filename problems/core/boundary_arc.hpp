#pragma once

#include <array>
#include <optional>
#include <vector>

#include "problems/core/cell_faces.hpp"

namespace strongpoint {

/// Places quadrature points along the boundary of a domain between two positions on it. A straight
/// stretch gets the points of its chord. On a curved one the Gauss points of the chord are moved
/// along the chord's normal onto the boundary, and lengths come from the derivative of the
/// polynomial through them and the ends; a stretch that this polynomial does not follow to 1e-11 of
/// its length is halved, up to 8 times. Area vectors add up to those of the chord by round-off.
class BoundaryArc {
 public:
  /// `gauss` points on straight stretches, 6 on curved ones.
  BoundaryArc(const Domain<2>& domain, int gauss);

  /// Positions are relative to this one from now on.
  void set_centre(const Point<2>& centre) { centre_ = centre; }
  /// Distance of the domain at a position.
  double distance(const Point<2>& x) const { return domain_.distance(centre_ + x); }
  /// Appends the points between two positions on the boundary, the domain to the left of the way;
  /// sides are left at -1. The centre, when it lies on the boundary between them, is where a
  /// stretch is split first.
  void trace(const Point<2>& from, const Point<2>& to, std::vector<FacePoint<2>>& points) {
    trace(from, to, 0, points);
  }

 private:
  static constexpr int curved_points = 6;
  using Heights = std::array<double, curved_points>;
  /// A stretch: its chord, with the normal that points out of the domain.
  struct Chord;

  const Domain<2>& domain_;
  LineRule straight_, curved_;
  std::array<Heights, curved_points> derivative_;  ///< of the polynomial with heights 0 at its ends
  std::array<Heights, 2> between_;                 ///< its values at `checked_places`
  Point<2> centre_ = Point<2>::Zero();
  std::vector<double> scratch_;

  void trace(const Point<2>& from, const Point<2>& to, int depth,
             std::vector<FacePoint<2>>& points);
  double tolerance(const Chord& chord, double relative) const;
  bool is_straight(const Chord& chord) const;
  std::optional<double> height(const Chord& chord, double t);
  bool follow(const Chord& chord, Heights& heights);
  void add_straight(const Chord& chord, std::vector<FacePoint<2>>& points) const;
  void add_curved(const Chord& chord, const Heights& heights,
                  std::vector<FacePoint<2>>& points) const;
  Point<2> middle(const Chord& chord, int depth);
};

}  // namespace strongpoint
