#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "methods/core/sites.hpp"

namespace strongpoint {

/// A node's place on one side of the boundary.
template <int Dim>
struct BoundaryMark {
  int side;           ///< index into the domain's sides
  Point<Dim> normal;  ///< outward unit normal of that side at the node
};

/// Nodes with their boundary marks: a node inside has none, a node on a side one, a corner several.
template <int Dim>
struct PointCloud {
  Points<Dim> nodes;                     ///< (Dim, N)
  std::vector<int> mark_offsets{0};      ///< (N + 1)
  std::vector<BoundaryMark<Dim>> marks;  ///< by node, ascending by side within a node
  std::optional<IndexBlock<Dim>> block;  ///< structured clouds only
  double measure = 0;                    ///< length, area or volume of the domain

  int size() const { return static_cast<int>(nodes.cols()); }
  /// The boundary marks of a node, empty inside.
  std::span<const BoundaryMark<Dim>> marks_of(int node) const {
    return {marks.data() + mark_offsets[node], marks.data() + mark_offsets[node + 1]};
  }
  /// The patch a node belongs to.
  int patch_of(int) const { return 0; }
  bool is_boundary(int node) const { return mark_offsets[node + 1] > mark_offsets[node]; }
  /// (measure / N)^(1/Dim), the `spacing` of the tables.
  double spacing() const;
};

/// The sites of a cloud with a stencil at every node, whatever a problem reads there.
template <int Dim>
Sites<Dim> sites_of_cloud(const PointCloud<Dim>& cloud);

/// Collects nodes one by one.
template <int Dim>
class CloudBuilder {
 public:
  /// Appends a node; marks may come in any order, a side given twice counts once.
  void add(const Point<Dim>& x, std::vector<BoundaryMark<Dim>> marks = {});
  int size() const { return static_cast<int>(nodes_.size()); }
  const Point<Dim>& node(int i) const { return nodes_[i]; }
  /// Builds the cloud and empties the builder. Throws CaseError, naming nodes and remedy, for a
  /// coordinate that is not finite, for coincident nodes and for fewer than two nodes.
  PointCloud<Dim> finish(double measure);

 private:
  std::vector<Point<Dim>> nodes_;
  std::vector<std::vector<BoundaryMark<Dim>>> marks_;
};

}  // namespace strongpoint
