#pragma once

#include <span>
#include <vector>

#include "problems/core/boundary_arc.hpp"
#include "problems/core/cell_faces.hpp"
#include "problems/core/convex_cell.hpp"
#include "problems/core/crossing_pairs.hpp"

namespace strongpoint {

/// Corners of a domain, and other places where its sides meet: the ends of its pieces and nodes on
/// two sides or more.
std::vector<Point<2>> boundary_corners(const PointCloud<2>& cloud, const Domain<2>& domain);

/// Follows the boundary of what a polygon about a node and the domain have in common: the parts of
/// the polygon's edges that lie inside, closed along the boundary of the domain. Works on one node
/// after the other in the same memory.
class CellOutline {
 public:
  /// Everything must outlive the outline.
  CellOutline(const PointCloud<2>& cloud, const Domain<2>& domain,
              const std::vector<Point<2>>& corners, int gauss);

  /// Appends the quadrature points of a node's cell; the polygon is relative to the node, its edges
  /// labelled with the nodes beyond. Returns the largest distance from the node to the cell's
  /// boundary.
  double add(int node, const ConvexCell<2>& polygon, std::vector<FacePoint<2>>& points);
  /// Whether the boundary inside the polygon last given could not be followed: the cell is too
  /// large for its features.
  bool is_broken() const { return is_broken_; }

 private:
  const PointCloud<2>& cloud_;
  const Domain<2>& domain_;
  const std::vector<Point<2>>& corners_;
  LineRule face_rule_;
  BoundaryArc arc_;
  int node_ = 0;
  Point<2> centre_ = Point<2>::Zero();
  double radius_ = 0;
  bool is_broken_ = false;
  const ConvexCell<2>* polygon_ = nullptr;
  std::vector<double> distances_;  ///< of the polygon's corners
  std::vector<double> parameters_;
  std::vector<BoundaryCrossing> crossings_;
  CrossingPairs pairs_;
  std::vector<std::vector<Point<2>>> ways_;  ///< of each stretch, through the corners; kept to grow

  double distance(const Point<2>& x) const { return domain_.distance(centre_ + x); }
  void add_inner_faces(std::vector<FacePoint<2>>& points);
  void add_face(const Point<2>& from, const Point<2>& to, int neighbour,
                std::vector<FacePoint<2>>& points) const;
  void pair_crossings();
  Point<2> way_along_boundary(const Point<2>& x) const;
  std::span<std::vector<Point<2>>> ways() { return {ways_.data(), pairs_.stretches().size()}; }
  void put_corners_on_ways();
  bool holds(const Point<2>& corner) const;
  void put_in_order(std::vector<Point<2>>& way) const;
  double misfit(const std::vector<Point<2>>& way) const;
  void add_boundary(std::vector<FacePoint<2>>& points);
};

}  // namespace strongpoint
