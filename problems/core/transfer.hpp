#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "problems/core/aggregation.hpp"
#include "problems/core/block_factors.hpp"
#include "problems/core/block_matrix.hpp"

namespace strongpoint {

/// The way from the nodes of a level to their aggregates and back, a block each way for every node.
template <int Size, int Coarse>
struct Transfer {
  Aggregates aggregates;
  std::vector<float> down;  ///< (nodes * Size * Coarse) P, how a node follows its aggregate
  std::vector<float> up;    ///< (nodes * Coarse * Size) R, how its rows are summed
};

/// Every node follows its aggregate as it is; rows are summed after a product with D^-1, the
/// inverses of the diagonal blocks or unit blocks where these are singular. D makes the rows of
/// collocation alike: those of a traction have other magnitudes and signs than those of the
/// equilibrium.
template <int Size>
Transfer<Size, Size> constant_transfer(const BlockMatrix<Size>& matrix,
                                       const Aggregates& aggregates);

/// Plane bodies that move as rigid ones: nodes, or aggregates of them. One with a radius also
/// turns, its third unknown being the displacement that this gives at the radius.
struct PlaneBodies {
  Eigen::Matrix2Xd places;
  Eigen::VectorXd radii;  ///< 0 for nodes, which do not turn
};

/// Nodes follow their aggregates as rigid bodies. Forces and moments are summed, after a product
/// with `weights`, (nodes * 2), that make forces of rows. Replaces `bodies` by the aggregates.
Transfer<2, 3> rigid_transfer(const Aggregates& aggregates, PlaneBodies& bodies,
                              const Eigen::VectorXd& weights);

/// The same for bodies that turn, whose rows are forces and moments.
Transfer<3, 3> rigid_transfer(const Aggregates& aggregates, PlaneBodies& bodies);

/// The Galerkin product and what a cycle needs of it. An unknown that no node follows stands for
/// itself, with a 1 on the diagonal.
template <int Size, int Coarse>
struct CoarseLevel {
  BlockMatrix<Coarse> matrix;                 ///< R A P
  SingleMatrix<Size, Coarse> fine_to_coarse;  ///< A P, (fine rows, aggregates), padded
};

template <int Size, int Coarse>
CoarseLevel<Size, Coarse> coarsen(const BlockMatrix<Size>& matrix,
                                  const Transfer<Size, Coarse>& transfer);

}  // namespace strongpoint
