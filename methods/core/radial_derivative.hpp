#pragma once

#include <array>
#include <vector>

#include "methods/core/derivatives.hpp"
#include "methods/core/points.hpp"

namespace strongpoint {

/// A derivative of a radial function f(s), s = |x|^2, as a sum of c * x^a * f^(m)(s).
/// Source: chain rule, d^n f/dx^n = sum_j n!/(j!(n-2j)!) (2x)^(n-2j) f^(n-j)(s), one such sum per
/// coordinate.
template <int Dim>
class RadialDerivative {
 public:
  /// One term of the sum.
  struct Term {
    double coefficient;
    std::array<int, Dim> exponents;
    int outer;  ///< m, order of the derivative of f
  };

  explicit RadialDerivative(const MultiIndex<Dim>& alpha);

  const std::vector<Term>& terms() const { return terms_; }
  /// Value at x from f[m] = f^(m)(|x|^2), m = 0 to the order of the derivative. At x = 0 only the
  /// terms without a power of a coordinate count, so that f[m] may be infinite there where the
  /// function is smooth enough nevertheless (r^3, cubic splines).
  double operator()(const Point<Dim>& x, const double* f) const;

 private:
  std::vector<Term> terms_;
};

extern template class RadialDerivative<1>;
extern template class RadialDerivative<2>;
extern template class RadialDerivative<3>;

}  // namespace strongpoint
