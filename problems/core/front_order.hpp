#pragma once

#include <vector>

#include "problems/core/node_graph.hpp"

namespace strongpoint {

/// Nodes in an order that lets a front of few nodes sweep over the graph. Cost: a few passes over
/// the graph, and for each node one over the nodes beside the front. Source: Sloan 1986, An
/// algorithm for profile and wavefront reduction, with weights 1 and 2.
std::vector<int> front_order(const NodeGraph& graph);

}  // namespace strongpoint
