#pragma once

#include "methods/core/simd/monomial_list.hpp"
#include "methods/core/simd/smoothing_profile.hpp"
#include "methods/core/simd/taylor_kernel.hpp"

namespace strongpoint {

/// One product of Leibniz' rule: binomial times a derivative of the window, counted as
/// Derivatives::between_orders(0, 2), times that of another derivative's polynomial.
struct WindowProduct {
  int window;
  int function;
  double binomial;
};

/// Polynomial fits whose value is unknown at a group of anchors, as many as the path has lanes or
/// less: what they are weighted by is fixed, or moves with the point of evaluation.
struct MovingTask {
  StencilTable table;
  int dim;                          ///< 1 to 3
  const SmoothingProfile* profile;  ///< the window that moves; null when it is fixed
  const double* spacing;            ///< (A) of the anchors, for the window
  const double* squared;            ///< (lane, n) a fixed window, null for ones
  const double* volumes;          ///< (N) of the nodes, which the window is multiplied by, or null
  MonomialList monomials;         ///< with the constant
  double condition_limit;         ///< in the 1-norm of the moment matrix of unit diagonal
  DerivativeTable known;          ///< derivatives that have to be found, by order
  const WindowProduct* products;  ///< what is known before of each
  const int* product_offsets;     ///< (known + 1)
  const int* asked;               ///< (D) places of the derivatives asked for
  int count;                      ///< D
  PointTable points;
  double* scratch;  ///< at a cache line, moving_scratch numbers
  unsigned* done;   ///< bits of the lanes whose weights were written
};

/// Numbers of scratch that the task takes: n nodes at most, m monomials, K known derivatives, D
/// asked for.
inline std::size_t moving_scratch(std::size_t dim, std::size_t n, std::size_t m, std::size_t known,
                                  std::size_t asked, std::size_t lanes) {
  const std::size_t windows = (dim + 1) * (dim + 2) / 2;
  return lanes *
         (n * (dim + 2 + 2 * m + windows + 2 * known + asked) + m * (3 * m + 2 * known + 3));
}

/// Writes the weights of all points of the anchors whose moment matrices are well conditioned
/// there.
STRONGPOINT_SIMD_KERNEL(fit_moving, MovingTask);

}  // namespace strongpoint
