#pragma once

#include <array>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// How nodes are spaced along the axes of a block, on [-1, 1].
enum class BlockNodes {
  uniform,    ///< equidistant
  clustered,  ///< asin(0.9 cos t) / asin(0.9), t equidistant: denser at the ends, for differences
              ///< of high order
  chebyshev,  ///< cos t, for polynomials through the whole line
  gll         ///< points of the Gauss-Lobatto rule
};

/// The n >= 2 coordinates from 0 to 1, ascending; both ends are exact.
std::vector<double> block_axis(BlockNodes nodes, int n);

/// Jacobian of a smooth map of the unit cube, (i, c) = dx_i / d unit_c, by differences on a window
/// of Chebyshev nodes: exact but for 1e-12 where the map is analytic well beyond the cube.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> jacobian(const std::function<Point<Dim>(const Point<Dim>&)>& map,
                                         const Point<Dim>& unit);

/// Ends of `cells` cells of [0, 1], (cells + 1), whose widths shrink from the middle towards both
/// ends by the factor `ratio` from one to the next, 1 for equal ones.
std::vector<double> cell_ends(int cells, double ratio);

/// The nodes of all blocks of a domain: one part for every cell that the blocks are cut into along
/// each axis (`ends`: see cell_ends), with the tensor product of one list of coordinates. Faces
/// between parts carry interface marks, normals by the Jacobian of the block's map. Throws
/// CaseError when nodes coincide or are not finite.
template <int Dim>
PointCloud<Dim> block_cloud(const Domain<Dim>& domain, const std::vector<double>& axis,
                            const std::array<std::vector<double>, Dim>& ends);

}  // namespace strongpoint
