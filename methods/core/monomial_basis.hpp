#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_solvers.hpp"
#include "methods/core/local_stencil.hpp"
#include "methods/core/method.hpp"
#include "methods/core/monomial.hpp"

namespace strongpoint {

/// All monomials z^a of degree `least` to `degree`, by degree: with the constant where the value is
/// unknown, without it where the value at the centre is known.
template <int Dim>
class MonomialBasis {
 public:
  /// `least` is 0 or 1.
  MonomialBasis(int least, int degree);

  int degree() const { return degree_; }
  int terms() const { return monomials_.size(); }
  const Derivatives<Dim>& monomials() const { return monomials_; }
  /// Fills the monomials at a position: result[a] = z^a, `terms()` of them.
  void evaluate(const double* z, double* result) const {
    if (has_constant_) result[0] = 1;
    for (int a = has_constant_ ? 1 : 0; a < terms(); ++a) {
      result[a] = (parent_[a] < 0 ? 1.0 : result[parent_[a]]) * z[axis_[a]];
    }
  }
  /// Fills a derivative of every monomial: result[a] = d^alpha z^a.
  void differentiate(const Point<Dim>& z, const MultiIndex<Dim>& alpha, double* result) const;
  /// QR of the matrix of T_j z_j^a, (nodes, terms), where `squared` holds T^2. The stencil has at
  /// least as many nodes as there are terms. `too_small` or `singular` when the fit is not unique.
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, std::span<const double> squared,
                         HouseholderQr& qr) const;
  /// The matrix of the normal equations, sum_j T_j^2 z_j^a z_j^b / b!, (terms, terms): rows are
  /// projections on the monomials, columns Taylor terms (with their factorials), scaled as asked;
  /// zero when the stencil is too small.
  Eigen::MatrixXd moments(const LocalStencil<Dim>& stencil, std::span<const double> squared,
                          Scaling scaling) const;

 private:
  bool has_constant_;
  int degree_;
  Derivatives<Dim> monomials_;
  std::vector<int> parent_;  ///< monomial a = monomial parent_[a] * z[axis_[a]], but for the
                             ///< constant; parent -1 is a constant that is left out
  std::vector<int> axis_;
};

/// QR of the matrix of monomials at the nodes of a stencil, (n, m), as interpolations with
/// polynomials need it. False when the nodes lie on the zero set of a polynomial.
template <int Dim>
bool factorise_polynomials(const LocalStencil<Dim>& stencil, const Derivatives<Dim>& monomials,
                           HouseholderQr& qr) {
  double* next = qr.prepare(stencil.size, monomials.size());
  for (const MultiIndex<Dim>& alpha : monomials) {
    for (int j = 0; j < stencil.size; ++j) {
      *next++ = monomial_derivative<Dim>(alpha, MultiIndex<Dim>{}, stencil.node(j));
    }
  }
  return qr.factorise(rank_tolerance);
}

extern template class MonomialBasis<1>;
extern template class MonomialBasis<2>;
extern template class MonomialBasis<3>;

}  // namespace strongpoint
