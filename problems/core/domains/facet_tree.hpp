#pragma once

#include <array>
#include <vector>

#include "problems/core/domains/boundary_mesh.hpp"

namespace strongpoint {

/// The place of a facet nearest to another place.
template <int Dim>
struct NearestPlace {
  int facet = -1;
  std::array<double, Dim> weights{};  ///< of the facet's corners, from 0 to 1; they add up to 1
  double squared_distance = 0;
};

/// Nearest places on some facets of a boundary, found through a tree of boxes.
template <int Dim>
class FacetTree {
 public:
  /// A tree over some facets of a mesh, at least one; the mesh must outlive it.
  FacetTree(const BoundaryMesh<Dim>& mesh, std::vector<int> facets);

  /// The place nearest to x. Does not allocate; may be called from several threads.
  NearestPlace<Dim> nearest(const Point<Dim>& x) const;

 private:
  struct Box {
    Point<Dim> low, high;
    int first, last;  ///< range in `facets_` of a leaf
    int right = -1;   ///< second child; the first one follows its parent; -1 for a leaf
  };
  const BoundaryMesh<Dim>& mesh_;
  std::vector<int> facets_;
  std::vector<Box> boxes_;

  void build(int first, int last);
  void search(int box, const Point<Dim>& x, NearestPlace<Dim>& best) const;
};

extern template class FacetTree<2>;
extern template class FacetTree<3>;

}  // namespace strongpoint
