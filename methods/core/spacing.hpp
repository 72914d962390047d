#pragma once

#include "methods/core/neighbours.hpp"
#include "methods/core/points.hpp"

namespace strongpoint {

/// Local spacing of the nodes around each query point, (queries): the distance from a node to its
/// Dim-th nearest other node, averaged over the 3^Dim nodes nearest to the query (ties kept). On a
/// grid it is the spacing, at edges and corners too. `search` holds the nodes.
template <int Dim>
Eigen::VectorXd local_spacing(const Points<Dim>& queries, const Points<Dim>& nodes,
                              const NeighbourSearch<Dim>& search);

}  // namespace strongpoint
