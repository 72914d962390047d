#pragma once

#include <vector>

#include <Eigen/Core>

#include "problems/core/solvers.hpp"

namespace strongpoint {

/// What tells rows of a plane system of two fields apart.
struct Balance {
  Eigen::VectorXd weights;         ///< (nodes * 2) what makes forces of the rows
  std::vector<char> has_traction;  ///< (nodes) 1 where a row takes first derivatives, else 0
};

/// What the rows of a plane system of two fields are multiplied by, so that their sum
/// over any patch is the balance of forces on it: rows of second derivatives stand for an area,
/// those of first derivatives for a length and with the other sign. The tractions inside then
/// cancel, and a coarse space that cannot resolve the boundary conserves them; without it
/// multigrid stalls on bending. What a row stands for is the lowest moment, about its node, that it
/// does not annihilate; length and area are those of the spacing of the row's nearest nodes; what
/// a row's moment has in units of stress is divided out. Rows of values get the size of the others
/// on the diagonal. Needs `places` and uses `row_scales` where they are known.
Balance balance_of(const LinearSystem& system);

}  // namespace strongpoint
