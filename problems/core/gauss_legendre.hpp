#pragma once

#include <vector>

namespace strongpoint {

/// A quadrature rule on [0, 1].
struct LineRule {
  std::vector<double> at;      ///< ascending
  std::vector<double> weight;  ///< positive, sum 1

  int size() const { return static_cast<int>(at.size()); }
};

/// Gauss-Legendre rule of n >= 1 points, exact for polynomials of degree 2n - 1. Nodes are found by
/// Newton's method on the Legendre polynomial.
LineRule gauss_legendre(int n);

/// Gauss-Lobatto rule of n >= 2 points, both ends among them, exact for polynomials of degree 2n -
/// 3. Nodes are found by Newton's method on (1 - x^2) P'.
LineRule gauss_lobatto(int n);

}  // namespace strongpoint
