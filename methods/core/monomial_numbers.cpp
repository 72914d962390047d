#include "methods/core/monomial_numbers.hpp"

namespace strongpoint {

template <int Dim>
void MonomialNumbers<Dim>::prepare(const Derivatives<Dim>& monomials,
                                   const Derivatives<Dim>& derivatives) {
  if (monomials == monomials_ && derivatives == derivatives_) return;
  monomials_ = monomials;
  derivatives_ = derivatives;
  axis_.clear();
  parent_.clear();
  orders_.clear();
  factors_.clear();
  powers_.clear();
  const auto place_of = [&](const MultiIndex<Dim>& alpha) {
    return order_of<Dim>(alpha) == 0 ? -1 : monomials.index(alpha);
  };
  for (const MultiIndex<Dim>& monomial : monomials) {
    int axis = 0;
    while (axis < Dim && monomial[axis] == 0) ++axis;
    MultiIndex<Dim> rest = monomial;
    if (axis < Dim) --rest[axis];
    axis_.push_back(axis < Dim ? axis : -1);
    parent_.push_back(place_of(rest));
  }
  for (const MultiIndex<Dim>& alpha : derivatives) {
    orders_.push_back(order_of<Dim>(alpha));
    for (const MultiIndex<Dim>& monomial : monomials) {
      MultiIndex<Dim> left{};
      bool vanishes = false;
      for (int c = 0; c < Dim; ++c) {
        left[c] = monomial[c] - alpha[c];
        vanishes = vanishes || left[c] < 0;
      }
      factors_.push_back(vanishes ? 0 : factorial<Dim>(monomial) / factorial<Dim>(left));
      powers_.push_back(vanishes ? -1 : place_of(left));
    }
  }
}

template class MonomialNumbers<1>;
template class MonomialNumbers<2>;
template class MonomialNumbers<3>;

}  // namespace strongpoint
