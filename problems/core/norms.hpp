#pragma once

#include <Eigen/Core>

namespace strongpoint {

/// Relative discrete 2-norm |computed - exact| / |exact|; any shape, components stacked.
template <class A, class B>
double relative_error(const Eigen::MatrixBase<A>& computed, const Eigen::MatrixBase<B>& exact) {
  return (computed - exact).norm() / exact.norm();
}

/// Relative maximum norm max|computed - exact| / max|exact|.
template <class A, class B>
double relative_max_error(const Eigen::MatrixBase<A>& computed, const Eigen::MatrixBase<B>& exact) {
  return (computed - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
}

}  // namespace strongpoint
