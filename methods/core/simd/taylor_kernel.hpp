#pragma once

#include "methods/core/simd/output.hpp"
#include "methods/core/simd/path.hpp"
#include "methods/core/simd/taylor_stencils.hpp"

namespace strongpoint {

/// The derivatives asked for, as kernels read them: d^alpha of monomial a is factor * z^power.
struct DerivativeTable {
  int count;              ///< D
  const int* order;       ///< (D) of differentiation
  const double* factors;  ///< (terms, D) 0 where the derivative vanishes
  const int* powers;      ///< (terms, D) place of the monomial that is left; -1 for the constant
  const int* own;         ///< (D) the monomial that leaves a constant, -1 for the value itself
};

/// Where derivatives are evaluated and where their weights go.
struct PointTable {
  const double* points;         ///< (Dim, P) coordinates, point after point
  const std::int64_t* offsets;  ///< (A + 1) of the anchors' lists in `ids`
  const int* ids;               ///< points of each anchor
  const std::int64_t* rows;     ///< (P + 1) entries of each point's row of weights
  double* values;               ///< (D * entries) the weights
};

/// Taylor fits.
struct TaylorTask {
  TaylorStencils stencils;
  DerivativeTable derivatives;
  PointTable points;
  Output output;    ///< how weights are stored where rows lie in one piece
  double* scratch;  ///< at a cache line, taylor_scratch numbers
  unsigned* done;   ///< (group) bits of the lanes whose weights were written
};

/// Numbers of scratch that a Taylor task takes: n nodes at most, m monomials, D derivatives.
inline std::size_t taylor_scratch(std::size_t n, std::size_t m, std::size_t derivatives,
                                  std::size_t lanes) {
  return lanes * (2 * n * derivatives + 2 * m * derivatives);
}

/// Factorises the moment matrices and writes the weights of all points of anchors whose systems are
/// well conditioned.
STRONGPOINT_SIMD_KERNEL(fit_taylor, TaylorTask);

}  // namespace strongpoint
