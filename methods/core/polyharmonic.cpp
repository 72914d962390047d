#include "methods/core/polyharmonic.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/monomial.hpp"

namespace strongpoint {
namespace {

/// A polynomial column this close to the span of the others means that the nodes lie on its zero
/// set.
constexpr double rank_tolerance = 1e-11;
/// Smallest pivot over diagonal entry of the projected kernel matrix that is trusted as definite.
constexpr double pivot_tolerance = 1e-14;

double factorial_of(int n) { return std::tgamma(n + 1.0); }

}  // namespace

template <int Dim>
RadialPowerDerivative<Dim>::RadialPowerDerivative(int power, const MultiIndex<Dim>& alpha) {
  // j[c] counts how often coordinate c contributes the factor from differentiating 2x once more.
  MultiIndex<Dim> j{};
  while (true) {
    Summand summand{1, {}, power};
    int outer = 0;  // order of the derivative of f(s) = s^(power/2)
    for (int c = 0; c < Dim; ++c) {
      const int left = alpha[c] - 2 * j[c];
      summand.coefficient *=
          factorial_of(alpha[c]) / (factorial_of(j[c]) * factorial_of(left)) * std::pow(2.0, left);
      summand.exponents[c] = left;
      outer += alpha[c] - j[c];
    }
    for (int q = 0; q < outer; ++q) summand.coefficient *= 0.5 * power - q;
    summand.radial_power = power - 2 * outer;
    summands_.push_back(summand);
    int c = 0;
    while (c < Dim && 2 * (j[c] + 1) > alpha[c]) j[c++] = 0;
    if (c == Dim) break;
    ++j[c];
  }
}

template <int Dim>
double RadialPowerDerivative<Dim>::operator()(const Point<Dim>& x, double r) const {
  if (r == 0) return 0;  // every summand is of degree power - |alpha| > 0
  double sum = 0;
  for (const Summand& summand : summands_) {
    double product = summand.coefficient;
    for (int c = 0; c < Dim; ++c) {
      for (int k = 0; k < summand.exponents[c]; ++k) product *= x[c];
    }
    for (int k = 0; k < summand.radial_power; ++k) product *= r;
    for (int k = 0; k > summand.radial_power; --k) product /= r;
    sum += product;
  }
  return sum;
}

template <int Dim>
PolyharmonicFit<Dim>::PolyharmonicFit(int phs, int degree)
    : phs_(phs), monomials_(Derivatives<Dim>::between_orders(0, degree)) {
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
  double* polynomials = work.polynomials.prepare(n, m);
  for (int a = 0; a < m; ++a) {
    for (int j = 0; j < n; ++j) {
      polynomials[static_cast<std::ptrdiff_t>(a) * n + j] =
          monomial_derivative<Dim>(monomials_[a], MultiIndex<Dim>{}, stencil.node(j));
    }
  }
  if (!work.polynomials.factorise(rank_tolerance)) return LocalOutcome::singular;
  work.kernel.resize(static_cast<std::size_t>(n) * n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double phi = std::pow((stencil.node(i) - stencil.node(j)).norm(), phs_);
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
    for (const MultiIndex<Dim>& alpha : derivatives) work.radials.emplace_back(phs_, alpha);
  }
  for (int d = 0; d < derivatives.size(); ++d) {
    for (int a = 0; a < m; ++a) {
      work.constraint[a] = monomial_derivative<Dim>(monomials_[a], derivatives[d], offset);
    }
    for (int j = 0; j < n; ++j) {
      const Point<Dim> x = offset - stencil.node(j);
      work.radial[j] = work.radials[d](x, x.norm());
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
Eigen::MatrixXd PolyharmonicFit<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                                   Scaling scaling) const {
  const int n = stencil.size;
  const int m = terms();
  if (n < m) return Eigen::MatrixXd::Zero(1, 1);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + m, n + m);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      matrix(i, j) = std::pow((stencil.node(i) - stencil.node(j)).norm(), phs_);
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
    if (order_of<Dim>(alpha) >= phs_) {
      return fmt::format("r^{} is not smooth enough for {}; ask for a larger odd phs", phs_,
                         name_of<Dim>(alpha));
    }
    if (order_of<Dim>(alpha) > monomials_.highest_order()) {
      return fmt::format("degree {} cannot give {} consistently; ask for degree={}",
                         monomials_.highest_order(), name_of<Dim>(alpha), order_of<Dim>(alpha));
    }
  }
  return {};
}

template class RadialPowerDerivative<1>;
template class RadialPowerDerivative<2>;
template class RadialPowerDerivative<3>;
template class PolyharmonicFit<1>;
template class PolyharmonicFit<2>;
template class PolyharmonicFit<3>;

}  // namespace strongpoint
