#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/local_solvers.hpp"

namespace strongpoint {

/// A derivative of r^k as a sum of c * x^a * r^(k - 2q).
/// Source: chain rule for f(s), s = |x|^2: d^n f/dx^n = sum_j n!/(j!(n-2j)!) (2x)^(n-2j)
/// f^(n-j)(s), one such sum per coordinate.
template <int Dim>
class RadialPowerDerivative {
 public:
  /// Derivative `alpha` of r^power; the power is odd and larger than the order of the derivative.
  RadialPowerDerivative(int power, const MultiIndex<Dim>& alpha);
  /// Value at x, whose length is r.
  double operator()(const Point<Dim>& x, double r) const;

 private:
  struct Summand {
    double coefficient;
    std::array<int, Dim> exponents;
    int radial_power;
  };
  std::vector<Summand> summands_;
};

/// Local interpolation by polyharmonic splines r^phs with all polynomials up to a degree.
/// The saddle-point system is solved in the null space of the polynomial constraints, where r^phs
/// is definite. Source: Flyer, Fornberg, Bayona, Barnett 2016; Wendland 2005, theorem 8.16.
template <int Dim>
class PolyharmonicFit {
 public:
  /// Buffers of one thread.
  struct Workspace {
    HouseholderQr polynomials;       ///< QR of the (n, m) polynomial matrix
    Ldlt definite;                   ///< projected r^phs, (n - m, n - m)
    std::vector<double> kernel;      ///< Q^T Phi Q, (n, n)
    std::vector<double> radial;      ///< (n)
    std::vector<double> constraint;  ///< (m)
    Derivatives<Dim> prepared;       ///< the derivatives that `radials` belongs to
    std::vector<RadialPowerDerivative<Dim>> radials;
  };

  /// Throws UsageError unless phs is odd and the degree is at least (phs - 1) / 2.
  PolyharmonicFit(int phs, int degree);

  int terms() const { return monomials_.size(); }
  int needed_nodes() const { return terms(); }
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) at `offset` from the anchor, all in units of the stencil radius.
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// The bordered matrix [Phi P; P^T 0], (n + m, n + m).
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives of order below phs, where r^phs is smooth enough, can be given.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  int phs_;
  Derivatives<Dim> monomials_;
};

extern template class RadialPowerDerivative<1>;
extern template class RadialPowerDerivative<2>;
extern template class RadialPowerDerivative<3>;
extern template class PolyharmonicFit<1>;
extern template class PolyharmonicFit<2>;
extern template class PolyharmonicFit<3>;

}  // namespace strongpoint
