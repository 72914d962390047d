#pragma once

#include <array>
#include <vector>

#include "problems/core/mesh_topology.hpp"

namespace strongpoint {

/// An element of a boundary: a segment in 2D, with the domain on its left, a triangle in 3D, seen
/// counter-clockwise from outside.
template <int Dim>
struct BoundaryFacet {
  std::array<int, Dim> corners;  ///< vertices
  int side;
  Point<Dim> area;  ///< outward normal times length or area

  Point<Dim> normal() const { return area.normalized(); }
};

/// A closed polyline or surface of triangles.
template <int Dim>
struct BoundaryMesh {
  Points<Dim> vertices;  ///< (Dim, V)
  std::vector<BoundaryFacet<Dim>> facets;
};

/// Takes the boundary out of a mesh whose boundary facets have sides; quadrangles become two
/// triangles.
template <int Dim>
BoundaryMesh<Dim> boundary_of(const Topology<Dim>& topology);

/// A normal for each part of each facet. The first Dim belong to its corners; in 3D the next three
/// to its edges, edge i being opposite to corner i; the last is the facet's own.
template <int Dim>
using FacetNormals = std::array<Point<Dim>, Dim == 2 ? 3 : 7>;

/// Outward normals, not of unit length, that tell on which side of the boundary a place lies from
/// the part of the facet nearest to it. Throws CaseError, naming the place, where the boundary
/// touches itself. Source: Baerentzen and Aanaes 2005, Signed distance computation using the angle
/// weighted pseudonormal.
template <int Dim>
std::vector<FacetNormals<Dim>> sign_normals(const BoundaryMesh<Dim>& mesh);

/// Unit normals of a side at the corners of each facet.
template <int Dim>
struct CornerNormals {
  /// Mean over the facets of the same side, weighted by length or area.
  std::vector<std::array<Point<Dim>, Dim>> at;
  /// The same over those only that meet the facet smoothly, for what lies between the corners.
  std::vector<std::array<Point<Dim>, Dim>> between;
};

/// Facets that turn by less than this belong to one smooth face, in degrees: a circle needs 13
/// edges.
inline constexpr double crease_angle_degrees = 30;

/// Normals of the sides at the vertices.
template <int Dim>
CornerNormals<Dim> corner_normals(const BoundaryMesh<Dim>& mesh);

/// Facets of a side in a row, in order, that no corner sharper than `crease_angle_degrees` breaks.
struct SmoothRun {
  int side;
  std::vector<int> facets;
};

/// The smooth runs of a plane boundary, by their first facet.
std::vector<SmoothRun> smooth_runs(const BoundaryMesh<2>& mesh);

}  // namespace strongpoint
