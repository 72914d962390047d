#pragma once

#include <array>
#include <optional>
#include <vector>

#include "problems/core/cell_faces.hpp"
#include "problems/core/convex_cell.hpp"
#include "problems/core/polyhedron_faces.hpp"

namespace strongpoint {

/// Places quadrature points on the boundary of what a polyhedron and a domain with one curved side
/// near it have in common. Faces are cut where their edges cross the side; between two crossings
/// they follow the curve in which their plane meets it, through 3 points. The patch of the side
/// within is a graph over its shadow along one direction, with the side's own normals; what its
/// rule leaves of the sum of the cell's area vectors is taken back from it. Works on one cell after
/// the other in the same memory.
class CurvedCell {
 public:
  /// Both must outlive the cell.
  CurvedCell(const Domain<3>& domain, const PolygonRule& rule);

  /// Appends the points of the cell of a node; the polyhedron is relative to it and labelled as by
  /// `CellMaker`, its flat sides cut. Returns the largest distance of a vertex from the node, or
  /// nothing, with no points, when the side cannot be followed.
  std::optional<double> add(const ConvexCell<3>& polyhedron, const Point<3>& centre, int side,
                            std::vector<FacePoint<3>>& points);

 private:
  static constexpr int curve_points = 3;
  /// Where an edge of the polyhedron, its lower vertex first, crosses the side.
  struct Crossing {
    int low, high;
    double t;  ///< along the edge
    Point<3> x;
  };
  /// The curve in a face from one crossing to another, the cell to its left seen from outside.
  struct Curve {
    int leaves, enters;                        ///< crossings
    Point<3> out;                              ///< unit, in the face, away from the cell
    std::array<double, curve_points> heights;  ///< of the side above the chord
    bool is_used = false;
  };

  const Domain<3>& domain_;
  const PolygonRule& rule_;
  LineRule curve_rule_;
  const ConvexCell<3>* polyhedron_ = nullptr;
  Point<3> centre_ = Point<3>::Zero();
  double radius_ = 0;
  double inside_ = 0;  ///< distances up to this count as inside
  int side_ = 0;
  std::vector<double> distances_;  ///< of the vertices
  std::vector<double> parameters_;
  std::vector<Crossing> crossings_;
  std::vector<Curve> curves_;
  std::vector<Point<3>> corners_;  ///< of a face inside the domain
  std::vector<int> ends_;          ///< crossings around a face
  std::vector<int> loop_;          ///< curves around a patch
  std::vector<FacePoint<3>> shadow_;

  double distance(const Point<3>& x) const { return domain_.distance(centre_ + x); }
  void find_edge_crossings();
  void walk_edge(int from, int to, std::vector<int>& ends);
  bool add_face(int face, std::vector<FacePoint<3>>& points);
  bool add_curve(int leaves, int enters, const Point<3>& normal, std::vector<FacePoint<3>>& points);
  std::optional<double> height(const Point<3>& x, const Point<3>& up, double reach);
  bool next_loop();
  bool add_patch(std::vector<FacePoint<3>>& points);
  bool raise_shadow(const Point<3>& up, std::vector<FacePoint<3>>& points);
  bool close(std::size_t first, std::size_t first_of_patches, std::vector<FacePoint<3>>& points);
};

}  // namespace strongpoint
