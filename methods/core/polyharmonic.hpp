#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/local_solvers.hpp"
#include "methods/core/polyharmonic_batch.hpp"
#include "methods/core/radial_derivative.hpp"
#include "methods/core/radial_function.hpp"

namespace strongpoint {

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
    std::vector<double> powers;      ///< (order + 1, n) r^phs and its derivatives by r^2
    std::vector<double> radial;      ///< (n)
    std::vector<double> constraint;  ///< (m)
    Derivatives<Dim> prepared;       ///< the derivatives that `radials` belongs to
    std::vector<RadialDerivative<Dim>> radials;
    PolyharmonicBatch<Dim> batch;
  };

  static constexpr bool reads_spans = true;

  /// Throws UsageError unless phs is odd and the degree is at least (phs - 1) / 2.
  PolyharmonicFit(int phs, int degree);

  int terms() const { return monomials_.size(); }
  int needed_nodes() const { return terms(); }
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) at `offset` from the anchor, all in units of the stencil radius.
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// Weights of many stencils side by side (polyharmonic_weights); those whose nodes are too few or
  /// nearly degenerate are left undecided.
  void fill_batch(const StencilBatch<Dim>& batch, Workspace& work, Weights& weights,
                  std::span<LocalOutcome> outcomes) const;
  /// The bordered matrix [Phi P; P^T 0], (n + m, n + m).
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives of order below phs, where r^phs is smooth enough, can be given.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  int phs_;
  RadialFunction power_;
  Derivatives<Dim> monomials_;
};

extern template class PolyharmonicFit<1>;
extern template class PolyharmonicFit<2>;
extern template class PolyharmonicFit<3>;

}  // namespace strongpoint
