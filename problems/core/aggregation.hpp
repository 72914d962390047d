#pragma once

#include <vector>

#include "problems/core/block_factors.hpp"
#include "problems/core/block_matrix.hpp"

namespace strongpoint {

/// Groups of nodes that one coarse node stands for.
struct Aggregates {
  std::vector<int> of_node;  ///< (nodes) the aggregate of each, -1 for a node outside all
  int count = 0;
};

/// Groups each node with the neighbours that its rows couple it to by at least `strong` times their
/// largest off-diagonal block; a node coupled to none, such as a fixed one, stays outside. Source:
/// Vaněk, Mandel, Brezina 1996, algorithm 5.1, with blocks for numbers. Deviation: a coupling is
/// measured against its row's largest, as the rows are not symmetric.
template <int Size>
Aggregates aggregate(const BlockMatrix<Size>& matrix, double strong);

/// The Galerkin product of plain aggregation and what a cycle needs of it. P holds one for each
/// node in its aggregate; D is the block diagonal of A, by which the rows of collocation become
/// alike: those of a traction have other magnitudes and signs than those of the equilibrium.
template <int Size>
struct CoarseLevel {
  BlockMatrix<Size> matrix;           ///< P^T D^-1 A P
  SingleMatrix<Size> fine_to_coarse;  ///< A P, (fine rows, aggregates), padded
  std::vector<float> inverses;  ///< (fine rows * Size * Size) D^-1; unit blocks where D is singular
};

template <int Size>
CoarseLevel<Size> coarsen(const BlockMatrix<Size>& matrix, const Aggregates& aggregates);

}  // namespace strongpoint
