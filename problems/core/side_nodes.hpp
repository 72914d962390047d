#pragma once

#include <vector>

#include "problems/core/flux_problem.hpp"
#include "problems/core/point_cloud.hpp"

namespace strongpoint {

/// Throws CaseError, naming the first, when a side of the domain has no node, so that what holds
/// there would never be written. Mirrored planes need none.
template <int Dim>
void check_nodes_on_all_sides(const Domain<Dim>& domain, const PointCloud<Dim>& cloud,
                              const std::vector<SymmetryPlane>& mirrored = {});

/// The same for the sides that give the value of some field, which forms write at nodes even where
/// they integrate all else.
template <int Dim>
void check_nodes_on_value_sides(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                                const std::vector<SymmetryPlane>& mirrored = {});

}  // namespace strongpoint
