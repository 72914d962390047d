#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_solvers.hpp"
#include "methods/core/local_stencil.hpp"
#include "methods/core/method.hpp"

namespace strongpoint {

/// All monomials z^a, |a| <= degree, the constant first: what fits with the value unknown share.
template <int Dim>
class MonomialBasis {
 public:
  explicit MonomialBasis(int degree);

  int degree() const { return degree_; }
  int terms() const { return monomials_.size(); }
  /// Fills the monomials at a position: result[a] = z^a, `terms()` of them.
  void evaluate(const double* z, double* result) const;
  /// Fills a derivative of every monomial: result[a] = d^alpha z^a.
  void differentiate(const Point<Dim>& z, const MultiIndex<Dim>& alpha, double* result) const;
  /// QR of the matrix of T_j z_j^a, (nodes, terms), where `squared` holds T^2. The stencil has at
  /// least as many nodes as there are terms. `too_small` or `singular` when the fit is not unique.
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, std::span<const double> squared,
                         HouseholderQr& qr) const;
  /// The matrix of the normal equations, sum_j T_j^2 z_j^a z_j^b / b!, (terms, terms): rows are
  /// projections on the monomials, columns Taylor terms, scaled as asked; zero when the stencil is
  /// too small.
  Eigen::MatrixXd moments(const LocalStencil<Dim>& stencil, std::span<const double> squared,
                          Scaling scaling) const;

 private:
  int degree_;
  Derivatives<Dim> monomials_;
  std::vector<int> parent_;  ///< monomial a = monomial parent_[a] * z[axis_[a]], from a = 1 on
  std::vector<int> axis_;
};

extern template class MonomialBasis<1>;
extern template class MonomialBasis<2>;
extern template class MonomialBasis<3>;

}  // namespace strongpoint
