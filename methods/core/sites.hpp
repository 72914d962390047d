#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "methods/core/points.hpp"
#include "methods/core/stencils.hpp"

namespace strongpoint {

/// Where an anchor lies; what is right inside is often wrong at a boundary.
enum class Zone : std::uint8_t { interior, boundary };

/// What a method or a stencil rule wants prepared beside the nodes; whatever is not asked for is
/// not made.
struct Needs {
  bool volumes = false;  ///< measure of each node's cell
  bool spacing = false;  ///< local spacing of the nodes around each anchor
  bool block = false;    ///< an index block: the cloud has to be structured
  bool centre = false;   ///< a node at every anchor, which then is in its stencil
  bool sight = false;    ///< which places see each other: segments that stay in the domain

  /// What either of two wants.
  friend Needs operator|(const Needs& a, const Needs& b) {
    return {.volumes = a.volumes || b.volumes,
            .spacing = a.spacing || b.spacing,
            .block = a.block || b.block,
            .centre = a.centre || b.centre,
            .sight = a.sight || b.sight};
  }
};

/// Index block of a structured cloud: node id = (i0 * shape[1] + i1) * shape[2] + i2.
template <int Dim>
struct IndexBlock {
  std::array<int, Dim> shape;
  /// Coordinates of the nodes along each axis before a map shaped them, from 0 to 1; empty lists:
  /// equidistant ones.
  std::array<std::vector<double>, Dim> axes{};
};

/// Whether the segment between two places stays in the domain; may be asked from several threads.
template <int Dim>
using Sight = std::function<bool(const Point<Dim>&, const Point<Dim>&)>;

/// Everything a method may look at: where unknowns live, where stencils are chosen, where
/// derivatives are evaluated. Made by a form from the cloud and the problem.
template <int Dim>
struct Sites {
  Points<Dim> nodes;                 ///< (Dim, N) carry the unknowns
  Points<Dim> anchors;               ///< (Dim, A) a stencil is chosen and factorised at each
  std::vector<int> anchor_node;      ///< (A) node at the anchor, -1 when there is none
  std::vector<Zone> anchor_zone;     ///< (A)
  std::vector<std::uint8_t> wanted;  ///< (A) 0: no derivative is needed, the stencil stays empty
  Points<Dim> points;                ///< (Dim, P) derivatives are evaluated here
  std::vector<int> point_anchor;     ///< (P) anchor of each point
  Points<Dim> spans;                 ///< (Dim, P), or empty for zeros: the weights of a point are
                                     ///< the means of those at point + span and point - span
  Eigen::VectorXd volumes;           ///< (N) cell measures, empty unless needed
  Eigen::VectorXd spacing;           ///< (A) local node spacing, empty unless needed
  std::optional<IndexBlock<Dim>> block;  ///< structured clouds only
  Sight<Dim> sees;                       ///< empty unless needed
  std::vector<int> node_numbers;         ///< what messages call the first nodes; empty: their ids
  std::vector<int> node_part;            ///< (N) part of each node, empty when there is one: no
                                         ///< stencil leaves the part of its anchor
  std::vector<int> anchor_part;          ///< (A) the same of each anchor
  std::vector<std::optional<IndexBlock<Dim>>> part_blocks;  ///< (parts) as `block`, ids within the
                                                            ///< part

  /// What messages call a node.
  int number_of(int node) const {
    return node < static_cast<int>(node_numbers.size()) ? node_numbers[node] : node;
  }
  int node_count() const { return static_cast<int>(nodes.cols()); }
  int anchor_count() const { return static_cast<int>(anchors.cols()); }
  int point_count() const { return static_cast<int>(points.cols()); }
  /// Number of parts that stencils keep within.
  int part_count() const { return part_blocks.empty() ? 1 : static_cast<int>(part_blocks.size()); }
  /// Ids of the anchors whose stencil is wanted.
  std::vector<int> wanted_anchors() const;
};

/// The evaluation points of each anchor, ascending: list a belongs to anchor a.
template <int Dim>
Stencils points_by_anchor(const Sites<Dim>& sites);

/// Sites with every node an anchor and an evaluation point, all wanted and interior.
template <int Dim>
Sites<Dim> sites_at_nodes(const Points<Dim>& nodes);

}  // namespace strongpoint
