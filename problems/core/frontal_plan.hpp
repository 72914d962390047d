#pragma once

#include <span>
#include <utility>
#include <vector>

#include "problems/core/node_graph.hpp"

namespace strongpoint {

/// What happens to the front when some nodes are eliminated: nodes enter behind those that are
/// there, then pairs of places are exchanged until the nodes to be eliminated come last.
struct FrontStep {
  int begin, end;                              ///< of the nodes eliminated, in the order
  std::vector<int> entering;                   ///< nodes
  std::vector<std::pair<int, int>> exchanges;  ///< places
  std::vector<int> nodes;                      ///< by place, those eliminated last
};

/// The steps of a frontal elimination of all nodes in an order, `at_once` nodes at a time.
std::vector<FrontStep> plan_fronts(const NodeGraph& graph, std::span<const int> order, int at_once);

}  // namespace strongpoint
