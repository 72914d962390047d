#pragma once

#include "methods/core/simd/monomial_list.hpp"
#include "methods/core/simd/smoothing_profile.hpp"
#include "methods/core/simd/taylor_kernel.hpp"

namespace strongpoint {

/// Taylor series up to order 2 projected on a smoothing kernel and its derivatives at a group of
/// anchors, as many as the path has lanes or less.
struct ProjectionTask {
  StencilTable table;
  int dim;                   ///< 1 to 3
  SmoothingProfile profile;  ///< the projections
  const double* spacing;     ///< (A) of the anchors
  const double* volumes;     ///< (N) of the nodes
  MonomialList monomials;    ///< of orders 0 or 1 to 2
  const int* block_end;      ///< (m) one past the last term that a projection sees
  const int* is_nodal;       ///< (m) 1 where it takes the value from the first node
  double condition_limit;    ///< of the growth of unpivoted factors times the condition
  DerivativeTable derivatives;
  PointTable points;
  double* scratch;  ///< at a cache line, projection_scratch numbers
  unsigned* done;   ///< bits of the lanes whose weights were written
};

/// Numbers of scratch that the task takes: n nodes at most, m terms, D derivatives.
inline std::size_t projection_scratch(std::size_t dim, std::size_t n, std::size_t m,
                                      std::size_t derivatives, std::size_t lanes) {
  return lanes * (n * (dim + 1 + 2 * m + derivatives) + m * (3 * m + 3 * derivatives + 4));
}

/// Writes the weights of all points of the anchors whose systems are well conditioned without
/// exchanging rows.
STRONGPOINT_SIMD_KERNEL(project_taylor, ProjectionTask);

}  // namespace strongpoint
