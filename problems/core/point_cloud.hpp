#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "methods/core/sites.hpp"

namespace strongpoint {

/// Side of a mark where the nodes' part of the cloud meets another one.
inline constexpr int interface_side = -1;

/// A node's place on one side of the boundary.
template <int Dim>
struct BoundaryMark {
  int side;           ///< index into the domain's sides, or `interface_side`
  Point<Dim> normal;  ///< outward unit normal of that side at the node
};

/// Nodes in a row that stencils stay within: a block of the domain, or one of its patches. Nodes of
/// several parts coincide where these meet.
template <int Dim>
struct Part {
  int first = 0;                         ///< id of the first node
  int count = 0;                         ///< number of nodes
  int patch = 0;                         ///< patch of the domain, whose data hold in the part
  std::optional<IndexBlock<Dim>> block;  ///< structured parts only; ids count from `first`
};

/// Nodes with their boundary marks: a node inside has none, a node on a side one, a corner several.
template <int Dim>
struct PointCloud {
  Points<Dim> nodes;                     ///< (Dim, N)
  std::vector<int> mark_offsets{0};      ///< (N + 1)
  std::vector<BoundaryMark<Dim>> marks;  ///< by node, ascending by side within a node
  std::optional<IndexBlock<Dim>> block;  ///< structured clouds of one part only
  double measure = 0;                    ///< length, area or volume of the domain
  std::vector<Part<Dim>> parts;          ///< ascending by node; empty: one part, patch 0
  std::vector<int> numbers;              ///< (N) what the user calls each node, from 0 on; empty:
                                         ///< its id
  Stencils twins;                        ///< (N) nodes of other parts at the place of a node with
                                         ///< interface marks, ascending; no rows with one part

  int size() const { return static_cast<int>(nodes.cols()); }
  /// What messages and results call a node: its number in the file it was read from.
  int number_of(int node) const { return numbers.empty() ? node : numbers[node]; }
  /// All marks of a node, those on interfaces first.
  std::span<const BoundaryMark<Dim>> all_marks_of(int node) const {
    return {marks.data() + mark_offsets[node], marks.data() + mark_offsets[node + 1]};
  }
  /// The marks of a node on sides of the domain, empty inside and on interfaces.
  std::span<const BoundaryMark<Dim>> marks_of(int node) const {
    return all_marks_of(node).subspan(interface_count(node));
  }
  /// The marks of a node on interfaces.
  std::span<const BoundaryMark<Dim>> interfaces_of(int node) const {
    return all_marks_of(node).first(interface_count(node));
  }
  /// The other nodes at a node's place.
  std::span<const int> twins_of(int node) const {
    return twins.size() == 0 ? std::span<const int>{} : twins[node];
  }
  /// Index into `parts` of the one a node belongs to; 0 when there are none.
  int part_of(int node) const;
  /// The patch of the domain a node belongs to.
  int patch_of(int node) const { return parts.empty() ? 0 : parts[part_of(node)].patch; }
  /// True at the boundary of the domain and on interfaces.
  bool is_boundary(int node) const { return mark_offsets[node + 1] > mark_offsets[node]; }
  /// (measure / N)^(1/Dim), the `spacing` of the tables.
  double spacing() const;

 private:
  std::size_t interface_count(int node) const {
    std::size_t count = 0;
    for (const BoundaryMark<Dim>& mark : all_marks_of(node)) {
      count += mark.side == interface_side ? 1 : 0;
    }
    return count;
  }
};

/// The sites of a cloud with a stencil at every node, whatever a problem reads there.
template <int Dim>
Sites<Dim> sites_of_cloud(const PointCloud<Dim>& cloud);

/// The nodes of one part as a cloud by themselves, without interface marks. Its measure is that of
/// the whole.
template <int Dim>
PointCloud<Dim> cloud_of_part(const PointCloud<Dim>& cloud, int part);

/// The cloud of one part without index structure whose node i is node order[i] of another one;
/// `numbers` keep what the nodes were called.
template <int Dim>
PointCloud<Dim> reordered(const PointCloud<Dim>& cloud, const std::vector<int>& order);

/// The cloud with its nodes along a Hilbert curve, so that what is near in space is near in memory;
/// `numbers` keep what the nodes were called. Clouds with index structure, and those of several
/// parts, stay as they are.
template <int Dim>
PointCloud<Dim> along_curve(const PointCloud<Dim>& cloud);

/// Values at the nodes, one column a node, in the order of the nodes' numbers; others as they are.
template <int Dim>
Eigen::MatrixXd in_given_order(const PointCloud<Dim>& cloud, const Eigen::MatrixXd& values);

/// Throws CaseError, naming the lowest, when a node on an interface meets no node of another part.
template <int Dim>
void check_interfaces(const PointCloud<Dim>& cloud);

/// Collects nodes one by one.
template <int Dim>
class CloudBuilder {
 public:
  /// Starts a new part, to which the nodes that follow belong; a cloud of parts begins with one.
  void begin_part(int patch, std::optional<IndexBlock<Dim>> block = {});
  /// Appends a node; marks may come in any order, a side given twice counts once, an interface as
  /// often as it has different normals.
  void add(const Point<Dim>& x, std::vector<BoundaryMark<Dim>> marks = {});
  int size() const { return static_cast<int>(nodes_.size()); }
  const Point<Dim>& node(int i) const { return nodes_[i]; }
  /// Builds the cloud and empties the builder. Throws CaseError, naming nodes and remedy, for a
  /// coordinate that is not finite, for coincident nodes of a part and for fewer than two
  /// nodes.
  PointCloud<Dim> finish(double measure);

 private:
  std::vector<Point<Dim>> nodes_;
  std::vector<std::vector<BoundaryMark<Dim>>> marks_;
  std::vector<Part<Dim>> parts_;
};

}  // namespace strongpoint
