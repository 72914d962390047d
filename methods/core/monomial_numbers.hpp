#pragma once

#include <vector>

#include "methods/core/derivatives.hpp"
#include "methods/core/simd/monomial_list.hpp"
#include "methods/core/simd/taylor_kernel.hpp"

namespace strongpoint {

/// Monomials and their derivatives as kernels read them.
template <int Dim>
class MonomialNumbers {
 public:
  /// Makes both tables; nothing is done when they are those of the last call. `monomials` are all
  /// of degree 0 or 1 to some degree.
  void prepare(const Derivatives<Dim>& monomials, const Derivatives<Dim>& derivatives);

  MonomialList list() const {
    return {static_cast<int>(axis_.size()), axis_.data(), parent_.data()};
  }
  DerivativeTable derivatives() const {
    return {static_cast<int>(orders_.size()), orders_.data(), factors_.data(), powers_.data(),
            nullptr};
  }

 private:
  Derivatives<Dim> monomials_, derivatives_;  ///< those that the rest belongs to
  std::vector<int> axis_, parent_, orders_, powers_;
  std::vector<double> factors_;
};

extern template class MonomialNumbers<1>;
extern template class MonomialNumbers<2>;
extern template class MonomialNumbers<3>;

}  // namespace strongpoint
