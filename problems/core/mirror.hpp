#pragma once

#include <algorithm>
#include <vector>

#include "problems/core/problem.hpp"
#include "problems/core/unknowns.hpp"

namespace strongpoint {

/// Who writes symmetry planes.
enum class Symmetry {
  by_default,  ///< rows in 1D and 2D, images in 3D
  rows,        ///< conditions at the nodes of the plane
  images       ///< mirror images of nodes, so that stencils are not cut off at the plane
};

/// The value of a form's option `symmetry`: rows, images or default.
Symmetry symmetry_choice(const Options& options);

/// Symmetry planes whose nodes' conditions are replaced by images.
template <int Dim>
std::vector<SymmetryPlane> mirrored_planes(const SteadyProblem<Dim>& problem, Symmetry symmetry);

/// True when all the sides a node lies on are among the planes.
template <int Dim>
bool lies_on_planes_only(std::span<const BoundaryMark<Dim>> marks,
                         const std::vector<SymmetryPlane>& planes) {
  for (const BoundaryMark<Dim>& mark : marks) {
    const auto is_side = [&](const SymmetryPlane& plane) { return plane.side == mark.side; };
    if (std::find_if(planes.begin(), planes.end(), is_side) == planes.end()) return false;
  }
  return !marks.empty();
}

/// Appends to the nodes of some sites their mirror images across the planes and, where planes meet,
/// across several: of each node within `reach` times its spacing of a plane, and not on it. All
/// nodes so far are unknowns, `spacing` (nodes) is theirs.
template <int Dim>
void append_images(const std::vector<SymmetryPlane>& planes, const Eigen::VectorXd& spacing,
                   Sites<Dim>& sites, NodeUnknowns& unknowns);

}  // namespace strongpoint
