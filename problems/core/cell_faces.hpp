#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/core/neighbours.hpp"
#include "problems/core/domain.hpp"
#include "problems/core/gauss_legendre.hpp"

namespace strongpoint {

/// A quadrature point on the boundary of a cell.
template <int Dim>
struct FacePoint {
  Point<Dim> x;
  Point<Dim> area;  ///< outward normal times this point's share of the length or area
  int side;         ///< side of the domain, -1 on a face shared with another cell
  int neighbour;    ///< node of the cell on the other side, -1 on the boundary of the domain
};

/// The boundaries of all cells, in compressed rows.
template <int Dim>
struct CellFaces {
  std::vector<std::int64_t> offsets{0};  ///< (N + 1)
  std::vector<FacePoint<Dim>> points;    ///< by node

  int size() const { return static_cast<int>(offsets.size()) - 1; }
  /// The points on the boundary of a node's cell.
  std::span<const FacePoint<Dim>> of(int node) const {
    return {points.data() + offsets[node], points.data() + offsets[node + 1]};
  }
};

/// Makes quadrature points on the faces of the Voronoi cells clipped to the domain, `gauss` (1 to
/// 4) a face and direction, for flux balances. The area vectors of each cell add up to zero, and a
/// face between two cells has the same points from both sides.
///
/// 2D: exact for integrands of degree 2 gauss - 1 on straight faces. Cells follow curved sides:
/// each stretch is an interpolant of degree 7 through points on the side (`boundary_arc.hpp`), and
/// cells add up to the domain to 1e-10. Corners are the ends of the domain's pieces and nodes on
/// two sides. Parts of the boundary that lie inside a cell without crossing its faces are missed.
/// 1D: the two ends, each of area 1. 3D: faces are cut into triangles with rules of 1, 3, 6 and 16
/// points, of degree 1, 2, 4 and 6, but a single point for the whole face when gauss is 1. Flat
/// sides cut exactly. Cells follow a curved side when it is the only one near them
/// (`curved_cell.hpp`); measures then err by O(h^2), O(h^4) and O(h^6) for gauss 1, 2 and 3 or
/// more. Elsewhere cells are cut by tangent planes, an error of O(h^2), and faces that end on the
/// side match to that order. Points near curved sides may have areas of either sign.
///
/// Throws CaseError, naming the node, for a cell that is empty or not bounded, or in which the
/// boundary cannot be followed (2D, cells larger than its features); CaseError when the cells do
/// not add up to the measure of the domain, by 1e-3 (3D: 1e-2) of it; and std::invalid_argument
/// unless gauss is 1 to 4.
template <int Dim>
CellFaces<Dim> cell_faces(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                          const NeighbourSearch<Dim>& search, int gauss);

/// Length, area or volume of a cell from the points on its boundary, by Gauss' theorem for the
/// position about the centre.
template <int Dim>
double cell_measure(const Point<Dim>& centre, std::span<const FacePoint<Dim>> points) {
  double sum = 0;
  for (const FacePoint<Dim>& point : points) sum += (point.x - centre).dot(point.area);
  return sum / Dim;
}

/// Integral of a function over a cell from the points on its boundary alone: the sum over cones
/// from the centre of (x - centre).area times the integral of r^(Dim-1) f(centre + r (x - centre))
/// over r in [0, 1], by 3 Gauss points. Cones of a cell that is not star-shaped about its centre
/// overlap with opposite signs, so that f is evaluated outside the cell as well. For f of degree 1
/// exact whenever the faces are.
template <int Dim, class F>
double integrate_over_cell(const Point<Dim>& centre, std::span<const FacePoint<Dim>> points,
                           F&& f) {
  static const LineRule radial = gauss_legendre(3);
  double sum = 0;
  for (const FacePoint<Dim>& point : points) {
    const Point<Dim> arm = point.x - centre;
    double along = 0;
    for (int i = 0; i < radial.size(); ++i) {
      const double r = radial.at[i];
      double density = radial.weight[i];
      for (int c = 1; c < Dim; ++c) density *= r;
      along += density * f(Point<Dim>(centre + r * arm));
    }
    sum += arm.dot(point.area) * along;
  }
  return sum;
}

}  // namespace strongpoint
