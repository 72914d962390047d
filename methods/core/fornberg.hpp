#pragma once

#include <span>

#include <Eigen/Core>

namespace strongpoint {

/// Weights of the derivatives of order 0 to `order` at x from the values at n > order distinct
/// nodes on a line, (order + 1, n): exact for polynomials of degree n - 1.
/// Source: Fornberg 1988, Generation of finite difference formulas on arbitrarily spaced grids,
/// Math. Comp. 51, 699-706, eqs. (3.8)-(3.12).
Eigen::MatrixXd fornberg_weights(std::span<const double> nodes, double x, int order);
/// The same into `weights`, (order + 1, n), without allocating.
void fornberg_weights(std::span<const double> nodes, double x, Eigen::Ref<Eigen::MatrixXd> weights);

}  // namespace strongpoint
