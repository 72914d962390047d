#pragma once

#include <vector>

#include "methods/core/neighbours.hpp"
#include "problems/core/flux_problem.hpp"

namespace strongpoint {

/// Nodes outside of the domain, each beside a boundary node, and the spacing that places them.
template <int Dim>
struct Ghosts {
  std::vector<int> of_node;  ///< (N) ghost of each node, -1: none
  std::vector<int> owners;   ///< (ghosts) the boundary node of each
  Eigen::VectorXd spacing;   ///< (N + ghosts) mean distance of the Dim + 1 nearest other nodes

  int size() const { return static_cast<int>(owners.size()); }
};

/// No ghosts yet, with the spacing of the nodes. `search` holds the cloud's nodes.
template <int Dim>
Ghosts<Dim> prepared_ghosts(const PointCloud<Dim>& cloud, const NeighbourSearch<Dim>& search);

/// Adds a ghost for each node with a condition on derivatives, unless it lies on mirrored planes
/// alone: one spacing off along the mean normal of the sides that give no value (of all its sides,
/// when each gives one), mirrored planes left out, and within these planes. Appends the ghosts to
/// the nodes of the sites. Throws CaseError, naming the node, when a ghost falls onto a node.
template <int Dim>
void place_ghosts(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                  const std::vector<SymmetryPlane>& planes, Sites<Dim>& sites, Ghosts<Dim>& ghosts);

}  // namespace strongpoint
