#pragma once

#include "methods/core/derivatives.hpp"
#include "methods/core/points.hpp"

namespace strongpoint {

/// d^gamma z^alpha at z.
template <int Dim>
double monomial_derivative(const MultiIndex<Dim>& alpha, const MultiIndex<Dim>& gamma,
                           const Point<Dim>& z) {
  double result = 1;
  for (int c = 0; c < Dim; ++c) {
    if (gamma[c] > alpha[c]) return 0;
    for (int k = 0; k < gamma[c]; ++k) result *= alpha[c] - k;
    for (int k = gamma[c]; k < alpha[c]; ++k) result *= z[c];
  }
  return result;
}

}  // namespace strongpoint
