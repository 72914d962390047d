#pragma once

#include <vector>

#include "problems/core/cell_faces.hpp"
#include "problems/core/convex_cell.hpp"

namespace strongpoint {

/// A quadrature rule on polygons, cut into triangles about one of their corners.
class PolygonRule {
 public:
  /// 1, 3, 6 or 16 points a triangle of degree 1, 2, 4 or 6, for gauss 1 to 4; a single point for
  /// the whole polygon when gauss is 1. Sources: Hammer and Stroud 1956 (3 points), Strang and Fix
  /// 1973 (6 points); 16 points are the Gauss-Legendre rule collapsed into a corner.
  explicit PolygonRule(int gauss);

  /// Appends the points of a plane polygon given by its corners.
  void add(const std::vector<Point<3>>& corners, std::vector<FacePoint<3>>& points) const;

 private:
  /// Position in a triangle as weights of its second and third corner.
  struct Place {
    double second, third, weight;
  };
  std::vector<Place> places_;
};

/// Appends the ends of an interval given relative to a centre and labelled as by `CellMaker`.
void add_ends(const ConvexCell<1>& cell, const Point<1>& centre, std::vector<FacePoint<1>>& points);

/// Appends the quadrature points on the faces of a polyhedron given and labelled likewise;
/// `corners` is overwritten.
void add_faces(const ConvexCell<3>& cell, const Point<3>& centre, const PolygonRule& rule,
               std::vector<Point<3>>& corners, std::vector<FacePoint<3>>& points);

/// Gives the points from `first` on the side or the neighbour that a face's label names.
void set_label(int label, std::size_t first, std::vector<FacePoint<3>>& points);

}  // namespace strongpoint
