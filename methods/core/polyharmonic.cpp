#include "methods/core/polyharmonic.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/monomial.hpp"
#include "methods/core/monomial_basis.hpp"

namespace strongpoint {
namespace {

/// Smallest pivot over diagonal entry of the projected kernel matrix that is trusted as definite.
constexpr double pivot_tolerance = 1e-14;

}  // namespace

template <int Dim>
PolyharmonicFit<Dim>::PolyharmonicFit(int phs, int degree)
    : phs_(phs),
      power_(RadialFunction::Form::odd_power, phs),
      monomials_(Derivatives<Dim>::between_orders(0, degree)) {
  if (phs % 2 == 0) {
    throw UsageError(
        fmt::format("rbf_fd: phs={} must be odd: even powers of r are polynomials", phs));
  }
  if (degree < (phs - 1) / 2) {
    throw UsageError(
        fmt::format("rbf_fd: phs={} needs degree={} at least, got {}", phs, (phs - 1) / 2, degree));
  }
}

template <int Dim>
LocalOutcome PolyharmonicFit<Dim>::factorise(const LocalStencil<Dim>& stencil,
                                             Workspace& work) const {
  const int n = stencil.size;
  const int m = terms();
  if (n < m) return LocalOutcome::too_small;
  if (!factorise_polynomials<Dim>(stencil, monomials_, work.polynomials)) {
    return LocalOutcome::singular;
  }
  work.kernel.resize(static_cast<std::size_t>(n) * n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double phi = 0;
      power_.evaluate((stencil.node(i) - stencil.node(j)).squaredNorm(), 0, 0, &phi);
      work.kernel[static_cast<std::size_t>(i) * n + j] = phi;
      work.kernel[static_cast<std::size_t>(j) * n + i] = phi;
    }
  }
  // Q^T Phi Q: Q^T on the columns, then, the result being transposed, on the rows.
  for (int pass = 0; pass < 2; ++pass) {
    for (int j = 0; j < n; ++j) {
      double* column = work.kernel.data() + static_cast<std::ptrdiff_t>(j) * n;
      work.polynomials.apply_q_transposed({column, column + n});
    }
    Eigen::Map<Eigen::MatrixXd>(work.kernel.data(), n, n).transposeInPlace();
  }
  double* definite = work.definite.prepare(n - m);
  for (int i = 0; i < n - m; ++i) {
    for (int j = 0; j <= i; ++j) {
      definite[i * (n - m) + j] = work.kernel[static_cast<std::size_t>(m + i) * n + m + j];
    }
  }
  return work.definite.factorise(pivot_tolerance) ? LocalOutcome::ok : LocalOutcome::singular;
}

template <int Dim>
void PolyharmonicFit<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                                    const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                                    Eigen::Map<Eigen::MatrixXd> weights) const {
  const int n = stencil.size;
  const int m = terms();
  work.radial.resize(n);
  work.constraint.resize(m);
  if (!(work.prepared == derivatives)) {
    work.prepared = derivatives;
    work.radials.clear();
    for (const MultiIndex<Dim>& alpha : derivatives) work.radials.emplace_back(alpha);
  }
  const int order = derivatives.highest_order();
  work.powers.resize(static_cast<std::size_t>(n) * (order + 1));
  for (int j = 0; j < n; ++j) {
    power_.evaluate((offset - stencil.node(j)).squaredNorm(), 0, order,
                    work.powers.data() + static_cast<std::ptrdiff_t>(j) * (order + 1));
  }
  for (int d = 0; d < derivatives.size(); ++d) {
    for (int a = 0; a < m; ++a) {
      work.constraint[a] = monomial_derivative<Dim>(monomials_[a], derivatives[d], offset);
    }
    for (int j = 0; j < n; ++j) {
      work.radial[j] =
          work.radials[d](offset - stencil.node(j),
                          work.powers.data() + static_cast<std::ptrdiff_t>(j) * (order + 1));
    }
    // w = Q [c1; c2] with R^T c1 = constraints and (Q2' Phi Q2) c2 = Q2' (radial - Phi Q1 c1).
    work.polynomials.solve_transposed_r(work.constraint);
    work.polynomials.apply_q_transposed(work.radial);
    for (int i = m; i < n; ++i) {
      for (int a = 0; a < m; ++a) {
        work.radial[i] -= work.kernel[static_cast<std::size_t>(a) * n + i] * work.constraint[a];
      }
    }
    work.definite.solve({work.radial.data() + m, work.radial.data() + n});
    std::copy(work.constraint.begin(), work.constraint.end(), work.radial.begin());
    work.polynomials.apply_q(work.radial);
    for (int j = 0; j < n; ++j) weights(d, j) = work.radial[j];
  }
}

template <int Dim>
void PolyharmonicFit<Dim>::fill_batch(const StencilBatch<Dim>& batch, Workspace& work,
                                      Weights& weights, std::span<LocalOutcome> outcomes) const {
  work.batch.prepare(phs_, monomials_, batch.derivatives);
  work.batch.fill(batch, weights, outcomes);
}

template <int Dim>
Eigen::MatrixXd PolyharmonicFit<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                                   Scaling scaling) const {
  const int n = stencil.size;
  const int m = terms();
  if (n < m) return Eigen::MatrixXd::Zero(1, 1);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + m, n + m);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      power_.evaluate((stencil.node(i) - stencil.node(j)).squaredNorm(), 0, 0, &matrix(i, j));
    }
    for (int a = 0; a < m; ++a) {
      const double value =
          monomial_derivative<Dim>(monomials_[a], MultiIndex<Dim>{}, stencil.node(i));
      const int order = order_of<Dim>(monomials_[a]);
      matrix(i, n + a) = value * (scaling == Scaling::row ? std::pow(stencil.radius, order) : 1.0);
      matrix(n + a, i) = value;
    }
  }
  return matrix;
}

template <int Dim>
std::string PolyharmonicFit<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  for (const MultiIndex<Dim>& alpha : derivatives) {
    std::string rough = power_.unsupported(order_of<Dim>(alpha), name_of<Dim>(alpha));
    if (!rough.empty()) return rough;
    if (order_of<Dim>(alpha) > monomials_.highest_order()) {
      return fmt::format("degree {} cannot give {} consistently; ask for degree={}",
                         monomials_.highest_order(), name_of<Dim>(alpha), order_of<Dim>(alpha));
    }
  }
  return {};
}

template class PolyharmonicFit<1>;
template class PolyharmonicFit<2>;
template class PolyharmonicFit<3>;

}  // namespace strongpoint
