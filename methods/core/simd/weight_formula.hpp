#pragma once

namespace strongpoint {

/// A weight function as kernels evaluate it for many nodes side by side: T^2 = p(x)^power with
/// p(x) = sum_i coefficients[i] x^i + by_cube max(0, knot - x)^3.
struct WeightFormula {
  /// What x is, where q = r / (support R) and R is the stencil's largest distance.
  enum class Variable {
    distance,  ///< q
    square     ///< q^2, which needs no root
  };
  static constexpr int most = 5;

  Variable variable = Variable::distance;
  double support = 1;
  double coefficients[most] = {};
  double knot = 0;
  double by_cube = 0;
  int power = 1;  ///< of either sign
};

}  // namespace strongpoint
