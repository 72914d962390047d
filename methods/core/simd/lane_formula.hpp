#pragma once

#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/weight_formula.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// A weight formula for a node of each lane.
class LaneFormula {
 public:
  explicit LaneFormula(const WeightFormula& formula)
      : scale_(all(formula.variable == WeightFormula::Variable::square
                       ? 1 / (formula.support * formula.support)
                       : 1 / formula.support)),
        knot_(all(formula.knot)),
        by_cube_(all(formula.by_cube)),
        has_knot_(formula.by_cube != 0),
        of_square_(formula.variable == WeightFormula::Variable::square),
        factors_(formula.power < 0 ? -formula.power : formula.power),
        divides_(formula.power < 0) {
    for (int i = 0; i < WeightFormula::most; ++i) {
      coefficients_[i] = all(formula.coefficients[i]);
      if (formula.coefficients[i] != 0) degree_ = i;
    }
  }

  /// T^2 at distances whose squares over R^2 are given.
  [[gnu::always_inline]] Pack at_square(Pack square) const {
    const Pack x = (of_square_ ? square : sqrt(square)) * scale_;
    Pack p = coefficients_[degree_];
    for (int i = degree_ - 1; i >= 0; --i) p = p * x + coefficients_[i];
    if (has_knot_) {
      const Pack below = max(all(0), knot_ - x);
      p = p + by_cube_ * (below * below * below);
    }
    return power(p);
  }

 private:
  Pack scale_, knot_, by_cube_;
  Pack coefficients_[WeightFormula::most];
  bool has_knot_, of_square_;
  int degree_ = 0;
  int factors_;
  bool divides_;

  [[gnu::always_inline]] Pack power(Pack p) const {
    if (factors_ == 0) return all(1);
    Pack result = p;
    Pack square = p;
    bool begun = false;
    for (int left = factors_; left > 0; left /= 2) {
      if (left % 2 != 0) {
        result = begun ? result * square : square;
        begun = true;
      }
      if (left > 1) square = square * square;
    }
    return divides_ ? all(1) / result : result;
  }
};

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
