#include "methods/core/radial_derivative.hpp"

#include <cmath>

namespace strongpoint {

template <int Dim>
RadialDerivative<Dim>::RadialDerivative(const MultiIndex<Dim>& alpha) {
  // j[c] counts how often coordinate c contributes the factor from differentiating 2x once more.
  MultiIndex<Dim> j{};
  while (true) {
    Term term{1, {}, 0};
    for (int c = 0; c < Dim; ++c) {
      term.exponents[c] = alpha[c] - 2 * j[c];
      term.outer += alpha[c] - j[c];
    }
    term.coefficient = factorial<Dim>(alpha) /
                       (factorial<Dim>(j) * factorial<Dim>(term.exponents)) *
                       std::pow(2.0, order_of<Dim>(term.exponents));
    terms_.push_back(term);
    int c = 0;
    while (c < Dim && 2 * (j[c] + 1) > alpha[c]) j[c++] = 0;
    if (c == Dim) break;
    ++j[c];
  }
}

template <int Dim>
double RadialDerivative<Dim>::operator()(const Point<Dim>& x, const double* f) const {
  const bool at_centre = x.squaredNorm() == 0;
  double sum = 0;
  for (const Term& term : terms_) {
    double power = term.coefficient;
    bool vanishes = false;
    for (int c = 0; c < Dim; ++c) {
      vanishes = vanishes || (at_centre && term.exponents[c] > 0);
      for (int k = 0; k < term.exponents[c]; ++k) power *= x[c];
    }
    if (!vanishes) sum += power * f[term.outer];
  }
  return sum;
}

template class RadialDerivative<1>;
template class RadialDerivative<2>;
template class RadialDerivative<3>;

}  // namespace strongpoint
