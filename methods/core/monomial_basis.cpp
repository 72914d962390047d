#include "methods/core/monomial_basis.hpp"

#include <cmath>

namespace strongpoint {

template <int Dim>
MonomialBasis<Dim>::MonomialBasis(int least, int degree)
    : has_constant_(least == 0),
      degree_(degree),
      monomials_(Derivatives<Dim>::between_orders(least, degree)) {
  for (const MultiIndex<Dim>& alpha : monomials_) {
    int axis = 0;
    while (axis < Dim && alpha[axis] == 0) ++axis;
    MultiIndex<Dim> lower = alpha;
    if (axis < Dim) --lower[axis];
    axis_.push_back(axis);
    parent_.push_back(monomials_.contains(lower) ? monomials_.index(lower) : -1);
  }
}

template <int Dim>
void MonomialBasis<Dim>::differentiate(const Point<Dim>& z, const MultiIndex<Dim>& alpha,
                                       double* result) const {
  for (int a = 0; a < terms(); ++a) {
    result[a] = monomial_derivative<Dim>(monomials_[a], alpha, z);
  }
}

template <int Dim>
LocalOutcome MonomialBasis<Dim>::factorise(const LocalStencil<Dim>& stencil,
                                           std::span<const double> squared,
                                           HouseholderQr& qr) const {
  const int m = terms();
  if (stencil.size < m) return LocalOutcome::too_small;
  double* matrix = qr.prepare(stencil.size, m);
  for (int j = 0; j < stencil.size; ++j) {
    const double* z = stencil.z.data() + static_cast<std::ptrdiff_t>(j) * Dim;
    double* row = matrix + j;  // monomials of a node lie one column apart
    const double weight = std::sqrt(squared[j]);
    if (has_constant_) row[0] = weight;
    for (int a = has_constant_ ? 1 : 0; a < m; ++a) {
      row[static_cast<std::ptrdiff_t>(a) * stencil.size] =
          (parent_[a] < 0 ? weight : row[static_cast<std::ptrdiff_t>(parent_[a]) * stencil.size]) *
          z[axis_[a]];
    }
  }
  return qr.factorise(rank_tolerance) ? LocalOutcome::ok : LocalOutcome::singular;
}

template <int Dim>
Eigen::MatrixXd MonomialBasis<Dim>::moments(const LocalStencil<Dim>& stencil,
                                            std::span<const double> squared,
                                            Scaling scaling) const {
  const int m = terms();
  if (stencil.size < m) return Eigen::MatrixXd::Zero(1, 1);
  Eigen::VectorXd basis(m);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(m, m);
  for (int j = 0; j < stencil.size; ++j) {
    evaluate(stencil.z.data() + static_cast<std::ptrdiff_t>(j) * Dim, basis.data());
    matrix.noalias() += squared[j] * basis * basis.transpose();
  }
  for (int a = 0; a < m; ++a) {
    double column = 1 / factorial<Dim>(monomials_[a]);
    if (scaling == Scaling::row) column *= std::pow(stencil.radius, order_of<Dim>(monomials_[a]));
    matrix.col(a) *= column;
  }
  return matrix;
}

template class MonomialBasis<1>;
template class MonomialBasis<2>;
template class MonomialBasis<3>;

}  // namespace strongpoint
