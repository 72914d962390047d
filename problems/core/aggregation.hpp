#pragma once

#include <vector>

#include "problems/core/block_matrix.hpp"

namespace strongpoint {

/// Groups of nodes that one coarse node stands for.
struct Aggregates {
  std::vector<int> of_node;  ///< (nodes) the aggregate of each, -1 for a node outside all
  int count = 0;
};

/// Which off-diagonal blocks of a row couple two nodes strongly.
struct StrongCouplings {
  double share = 0.07;  ///< of the row's largest, at least
  int most = 12;        ///< the largest of them; wide stencils would make aggregates too large
};

/// Groups each node with the neighbours that its rows couple it to strongly; a node coupled to
/// none, such as a fixed one, stays outside. Source: Vaněk, Mandel, Brezina 1996, algorithm 5.1,
/// with blocks for numbers. Deviations: a coupling is measured against its row's largest, as the
/// rows are not symmetric, and few are strong however wide the stencil is. Measured: only the
/// inward couplings of a one-sided row reach a quarter of its largest; aggregates along them alone
/// let the iteration stall.
template <int Size>
Aggregates aggregate(const BlockMatrix<Size>& matrix, const StrongCouplings& strong);

}  // namespace strongpoint
