#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "methods/core/sites.hpp"
#include "methods/core/stencils.hpp"

namespace strongpoint {

/// What became of the local system of one stencil.
enum class LocalOutcome : std::uint8_t {
  ok,
  too_small,   ///< fewer nodes than the local system has unknowns
  singular,    ///< nodes in a special position: on a line, a cross, a conic
  flat,        ///< singular to working precision: the functions are too flat
  coincident,  ///< two nodes at one place
  no_centre,   ///< the method needs a node at the anchor, as the first of the stencil
  no_block,    ///< the method needs a full index block of a structured cloud
  not_finite,  ///< a weight came out as NaN or infinity
  undecided,   ///< a batch leaves the stencil to be treated on its own
  infeasible   ///< no non-negative weights exist: the point lies outside the nodes' convex hull
};

/// One stencil in coordinates scaled by its radius, gathered once for a kernel.
template <int Dim>
struct LocalStencil {
  int size = 0;              ///< n, nodes, the centre included
  int centre = -1;           ///< position of the node at the anchor, -1 when there is none
  double radius = 1;         ///< R, the largest distance from the anchor
  double spacing = 0;        ///< local node spacing over R, 0 when the sites have none
  double rounding = 0;       ///< rounding unit of the coordinates over R
  std::span<const int> ids;  ///< (n) of the nodes
  const IndexBlock<Dim>* block = nullptr;  ///< where the ids lie, null when the sites have none
  std::vector<double> z;    ///< (Dim, n) positions relative to the anchor over R, node after node
  std::vector<double> rho;  ///< (n) distances over R
  std::vector<double> volumes;  ///< (n) cell measures over R^Dim, empty when the sites have none

  /// Position of node j.
  Eigen::Map<const Point<Dim>> node(int j) const {
    return Eigen::Map<const Point<Dim>>(z.data() + static_cast<std::ptrdiff_t>(j) * Dim);
  }
  /// Gathers the stencil of an anchor; `coincident` when two of its nodes are closer than 1e-10 R.
  LocalOutcome gather(const Sites<Dim>& sites, std::span<const int> nodes, int anchor);
};

/// Throws CaseError for the first of some anchors whose outcome is not ok; says what, where and the
/// remedy.
/// `needed` is the number of nodes that the local system takes at least.
template <int Dim>
void throw_first_failure(const Sites<Dim>& sites, const Stencils& stencils,
                         std::span<const int> anchors, std::span<const LocalOutcome> outcomes,
                         std::string_view kernel, int needed);

}  // namespace strongpoint
