#pragma once

#include <vector>

#include "problems/core/domain.hpp"
#include "problems/core/gauss_legendre.hpp"

namespace strongpoint {

/// Numbers of quadrature points in a disc.
struct DiscCounts {
  int radial;   ///< along a ray, and at least along each piece of the boundary
  int angular;  ///< around the whole disc
};

/// A point inside, with its share of the area.
struct AreaPoint {
  Point<2> x;
  double weight;
};

/// A point of the boundary, with its share of the length.
struct EdgePoint {
  Point<2> x;
  double weight;
  int side;
};

/// Quadrature over the part of a disc that lies in a domain, and over the part of the boundary that
/// lies in the disc.
struct DiscRule {
  std::vector<AreaPoint> area;
  std::vector<EdgePoint> edge;
};

/// Makes quadrature rules for discs in a plane domain.
class DiscQuadrature {
 public:
  DiscQuadrature(const Domain<2>& domain, DiscCounts counts);

  /// A disc that the boundary does not cut: Gauss points along equidistant rays.
  DiscRule whole(const Point<2>& centre, double radius) const;
  /// A disc that the boundary may cut. Its share of the domain is a sum of fans from the centre:
  /// over the arcs of the rim that lie in the domain, and over the pieces of the boundary that lie
  /// in the disc, dA = s (y - centre).n ds dl at centre + s (y - centre). The sum is exact for any
  /// shape: where the boundary hides a part of the domain from the centre, a fan is negative, and
  /// on a hollow boundary (a hole's) some points lie outside by up to radius^2 / (2 curvature
  /// radius). Exact corners; smooth pieces to the accuracy of the Gauss rules; a piece that enters
  /// the disc over less than an eighth of the radius may be missed (1.7e-4 radius^2). Cost: the
  /// boundary's length over the radius.
  DiscRule cut(const Point<2>& centre, double radius) const;

 private:
  /// A stretch of a boundary piece, from one parameter to another.
  struct Stretch {
    const BoundaryPiece<2>* piece;
    double from, to;
  };

  const Domain<2>& domain_;
  DiscCounts counts_;
  std::vector<BoundaryPiece<2>> pieces_;
  std::vector<double> lengths_;  ///< of the pieces
  LineRule radial_;

  int arc_points(double angle) const;
  void find_stretches(const BoundaryPiece<2>& piece, double length, const Point<2>& centre,
                      double radius, std::vector<Stretch>& stretches,
                      std::vector<double>& crossings) const;
  void add_arc(const Point<2>& centre, double radius, double from, double to, DiscRule& rule) const;
  void add_stretch(const Point<2>& centre, double radius, const Stretch& stretch,
                   DiscRule& rule) const;
};

}  // namespace strongpoint
