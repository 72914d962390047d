#pragma once

#include <vector>

#include "problems/core/point_cloud.hpp"

namespace strongpoint {

/// The nodes along a Hilbert curve.
template <int Dim>
Points<Dim> in_spatial_order(const Points<Dim>& nodes);

/// Areas of the Voronoi cells from CGAL's Delaunay triangulation (its plain kernel with exact
/// predicates, the range inserted in its own spatial order), one circumcentre a triangle; NaN where
/// a cell leaves the unit square.
std::vector<double> rival_measures(const Points<2>& nodes);

/// Volumes of the Voronoi cells in the unit cube from voro++, in blocks of some six nodes.
std::vector<double> rival_measures(const Points<3>& nodes);

}  // namespace strongpoint
