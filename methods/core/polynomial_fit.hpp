#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/local_solvers.hpp"
#include "methods/core/monomial_basis.hpp"
#include "methods/core/moving_batch.hpp"
#include "methods/core/stencil_size.hpp"
#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// Weighted least-squares fit of a polynomial whose value is unknown too, about any point:
/// minimise sum_j T_j^2 (u_j - sum_a c_a (x_j - x)^a)^2 over |a| <= degree, by QR. Unlike the
/// Taylor fit it needs no node at the anchor, and a node there has no more say than its weight.
/// Source: thesis 7.1 (unweighted); Mirzaei, Schaback, Dehghan 2012 (weighted).
template <int Dim>
class PolynomialFit {
 public:
  /// Buffers of one thread.
  struct Workspace {
    std::vector<double> distances;  ///< (n) where the weight is read
    std::vector<double> squared;    ///< (n) T^2
    std::vector<double> vector;     ///< (n)
    HouseholderQr qr;
    std::vector<int> product_offsets;  ///< (derivatives + 1) zeros: no window is differentiated
    MovingBatch<Dim> batch;
  };

  /// A weight that is infinite at the anchor (r^-3) is read no nearer than `nearest` stencil radii.
  PolynomialFit(int degree, std::shared_ptr<const WeightFunction> weight);

  /// A node this near, in stencil radii, has a finite say with any weight, yet one so large (10^3
  /// times the farthest node's for r^-3) that the fit almost passes through its value.
  static constexpr double nearest = 0.1;

  int degree() const { return basis_.degree(); }
  int needed_nodes() const { return basis_.terms(); }
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) at `offset` from the anchor, all in units of the stencil radius.
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// Weights of the anchors whose normal equations are well conditioned.
  void fill_batch(const StencilBatch<Dim>& batch, Workspace& work, Weights& weights,
                  std::span<LocalOutcome> outcomes) const;
  /// The matrix A of thesis (7.4), weighted: rows are projections on the monomials, columns Taylor
  /// terms (with their factorials), scaled as asked.
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives up to the degree of the fit can be given.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  MonomialBasis<Dim> basis_;
  std::shared_ptr<const WeightFunction> weight_;
  double least_distance_ = 0;  ///< `nearest` with a weight that is infinite at the anchor

  /// Fills T^2 at the nodes.
  void evaluate_weights(const LocalStencil<Dim>& stencil, std::vector<double>& distances,
                        std::vector<double>& squared) const;
};

extern template class PolynomialFit<1>;
extern template class PolynomialFit<2>;
extern template class PolynomialFit<3>;

/// Makes a method of one polynomial fit; `name` is used in messages. Stencils are sized by the
/// surplus, but never too small for a flat boundary of a grid.
template <int Dim>
std::unique_ptr<Method<Dim>> make_polynomial_method(std::string name, int degree,
                                                    std::shared_ptr<const WeightFunction> weight,
                                                    StencilSurplus surplus);

}  // namespace strongpoint
