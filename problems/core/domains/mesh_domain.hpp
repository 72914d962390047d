#pragma once

#include <memory>
#include <string>
#include <vector>

#include "problems/core/domain.hpp"
#include "problems/core/domains/facet_tree.hpp"

namespace strongpoint {

/// The region that a Gmsh mesh of first-order elements fills, in 2D or 3D. Its sides are the
/// physical groups of dimension Dim - 1, in the order of their numbers; curved sides are as good as
/// the mesh's edges, so that a finer mesh is a better geometry. Has no map from the unit cube; in
/// 3D no boundary pieces either, so that its own nodes are the only cloud.
template <int Dim>
class MeshDomain final : public Domain<Dim> {
 public:
  /// Takes the boundary out of a mesh read from `path`. Throws CaseError, beginning with the path,
  /// for groups or boundary that do not fit together, for a boundary that touches itself, and for
  /// nodes that are not in the plane.
  MeshDomain(const Mesh& mesh, std::string path);

  const std::vector<std::string>& sides() const override { return sides_; }
  double measure() const override { return measure_; }
  /// The longest extent along an axis.
  double reference_length() const override { return extent_; }
  /// Throws SkipCase: a mesh has no such map.
  Point<Dim> map(const Point<Dim>& unit) const override;
  /// Throws SkipCase, too.
  std::vector<int> sides_at(const Point<Dim>& unit) const override;
  /// At a vertex the mean over the side's elements there, weighted by length or area, as for the
  /// mesh's nodes; elsewhere between those, apart from corners sharper than `crease_angle_degrees`.
  Point<Dim> normal(int side, const Point<Dim>& x) const override;
  /// Exact for the polyline or the triangles everywhere.
  double distance(const Point<Dim>& x) const override;
  /// One piece a smooth run of a side's edges, by arc length; none in 3D.
  std::vector<BoundaryPiece<Dim>> pieces() const override;
  std::optional<std::string> own_mesh() const override { return path_; }

  /// The elements of the boundary.
  const BoundaryMesh<Dim>& boundary() const { return boundary_; }

 private:
  std::string path_;
  std::vector<std::string> sides_;
  double measure_ = 0;
  double extent_ = 0;
  BoundaryMesh<Dim> boundary_;
  std::vector<FacetNormals<Dim>> signs_;
  CornerNormals<Dim> normals_;
  std::unique_ptr<FacetTree<Dim>> tree_;
  std::vector<std::unique_ptr<FacetTree<Dim>>> tree_of_side_;

  void read(const Mesh& mesh);
};

extern template class MeshDomain<2>;
extern template class MeshDomain<3>;

}  // namespace strongpoint
