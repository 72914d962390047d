#pragma once

#include <span>
#include <utility>
#include <vector>

#include "problems/core/node_graph.hpp"

namespace strongpoint {

/// What happens to the front when some nodes are eliminated: nodes enter behind those that are
/// there; when others are taken out, the last ones move to their places.
struct FrontStep {
  int begin, end;                          ///< of the nodes eliminated, in the order
  std::vector<int> entering;               ///< nodes
  std::vector<int> pivots;                 ///< places of the nodes eliminated
  std::vector<std::pair<int, int>> moves;  ///< places, old and new, of nodes that fill gaps
  std::vector<int> nodes;                  ///< that stay, by place, then those eliminated
};

/// The steps of a frontal elimination of all nodes in an order, `at_once` nodes at a time.
std::vector<FrontStep> plan_fronts(const NodeGraph& graph, std::span<const int> order, int at_once);

}  // namespace strongpoint
