#pragma once

#include <span>
#include <vector>

#include "problems/core/sparse_factor.hpp"

namespace strongpoint {

/// Which nodes of a square system are coupled, both ways and without themselves, in compressed
/// rows, ascending.
struct NodeGraph {
  std::vector<int>
      offsets;  ///< (nodes + 1), empty when there are more couplings than an int counts
  std::vector<int> neighbours;

  int size() const { return static_cast<int>(offsets.size()) - 1; }
  /// Number of nodes that a node is coupled with.
  int degree(int node) const { return offsets[node + 1] - offsets[node]; }
  /// Nodes that a node is coupled with.
  std::span<const int> of(int node) const {
    return {neighbours.data() + offsets[node], neighbours.data() + offsets[node + 1]};
  }
};

/// The graph of a matrix with `fields` unknowns in turn for each node. Cost: a few passes over the
/// entries, nothing is sorted.
NodeGraph node_graph(const Eigen::Map<const RowMatrix>& matrix, int fields);

}  // namespace strongpoint
