#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "problems/core/convex_cell.hpp"
#include "problems/core/domain.hpp"

namespace strongpoint {

/// What is known of a cell.
enum class CellState {
  settled,   ///< it is the node's cell
  open,      ///< farther nodes might cut it
  unbounded  ///< neither nodes nor domain bound it
};

/// A cell's state and size.
struct CellExtent {
  CellState state;
  double measure;           ///< infinite when it is unbounded
  double farthest_squared;  ///< of the largest distance of a vertex from the node
};

/// Label of a face that a side of the domain made; faces between nodes carry the other node's
/// number.
inline constexpr int side_label(int side) { return -2 - side; }
/// The side of a face's label, -1 when no side made it.
inline constexpr int side_of_label(int label) { return label <= -2 ? -2 - label : -1; }

/// Makes Voronoi cells one after the other in the same memory, cut by the bisectors of neighbours
/// in order of distance until the security radius (no farther node can cut the cell).
template <int Dim>
class CellMaker {
 public:
  /// Both must outlive the maker.
  CellMaker(const PointCloud<Dim>& cloud, const Domain<Dim>& domain)
      : cloud_(cloud), domain_(domain) {}

  /// Makes the cell of a node, clipped to the domain, from its nearest nodes: exactly by flat
  /// sides, by tangent planes along curved ones. Neighbours are sorted by distance, and all nodes
  /// up to `reach` are among them.
  CellState make(int node, std::span<const int> neighbours, double reach);
  /// Measures the cell that `make` would make; `cell` is anything afterwards.
  CellExtent measure(int node, std::span<const int> neighbours, double reach);
  /// Makes the cell without the domain, within a box around the node.
  void make_unclipped(int node, std::span<const int> neighbours, double half_width);
  /// Clips the cell of a node last made by the domain, as `make` does.
  void clip_to_domain(int node);
  /// The cell last made, relative to its node.
  const ConvexCell<Dim>& cell() const { return cell_; }
  /// The same, for further cuts.
  ConvexCell<Dim>& cell() { return cell_; }

 private:
  const PointCloud<Dim>& cloud_;
  const Domain<Dim>& domain_;
  ConvexCell<Dim> cell_;
  struct Nothing {};
  std::conditional_t<Dim == 3, CutCell, Nothing> work_{};
  std::vector<SidePlane> side_planes_;

  bool cut(int node, std::span<const int> neighbours, double half_width,
           std::span<const BoundaryMark<Dim>> marks);
  bool cut_fast(int node, std::span<const int> neighbours, double half_width,
                std::span<const BoundaryMark<Dim>> marks);
  void clip(int node, std::span<const int> neighbours, double half_width);
  void clip_by_neighbours(int node, std::span<const int> neighbours);
  void clip_by_marks(int node);
  void clip_by_domain(const Point<Dim>& centre);
  bool measure_fast(int node, std::span<const int> neighbours, double half_width,
                    CellExtent& extent);
};

/// Half width of the box in which to make a cell whose neighbours reach this far. Nodes beyond
/// reach cannot cut what lies within half of it, and a cell that touches this box does not; so the
/// box never shows in a cell that counts.
inline double box_for(double reach) { return 0.5 * (1 + 1e-9) * reach; }

}  // namespace strongpoint
