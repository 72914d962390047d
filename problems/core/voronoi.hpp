#pragma once

#include "methods/core/neighbours.hpp"
#include "problems/core/domain.hpp"

namespace strongpoint {

/// Measures of the Voronoi cells of a cloud, clipped to the domain, (N). Each cell is cut by the
/// bisectors of its neighbours in order of distance until the security radius (no farther node can
/// cut it), then by the domain: exactly by flat sides, by tangent planes along curved ones, in 2D
/// along its boundary near re-entrant corners. In 3D cells at re-entrant edges lose what lies
/// beyond a side's plane. Throws CaseError, naming the node, when a cell is empty.
template <int Dim>
Eigen::VectorXd voronoi_volumes(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                                const NeighbourSearch<Dim>& search);

}  // namespace strongpoint
