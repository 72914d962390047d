#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/local_solvers.hpp"
#include "methods/core/monomial_basis.hpp"
#include "methods/core/stencil_size.hpp"
#include "methods/core/taylor_batch.hpp"
#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// Weighted least-squares fit of the Taylor series about a node whose value is known:
/// minimise sum_j T_j^2 (u_j - u_i - sum_a c_a (x_j - x_i)^a)^2 over 1 <= |a| <= order.
/// Source: novel and original MFPM (thesis 3.1, 3.2) with projection functions equal to the
/// monomials, GFDM (Benito et al. 2001) and LSFDM (Ding et al. 2004) are this fit with different
/// weights T.
template <int Dim>
class TaylorFit {
 public:
  /// Buffers of one thread.
  struct Workspace {
    std::vector<double> basis;            ///< (unknowns, n) monomials at the nodes
    std::vector<double> squared;          ///< (n) T^2, zero at the centre
    std::vector<double> right_hand_side;  ///< (n)
    Ldlt normal_equations;
    HouseholderQr qr;
    bool by_qr = false;
    TaylorBatch<Dim> batch;
  };

  /// Throws UsageError when the order is not within 1 to 8.
  TaylorFit(int order, std::shared_ptr<const WeightFunction> weight);

  int order() const { return basis_.degree(); }
  int unknowns() const { return basis_.terms(); }
  int needed_nodes() const { return unknowns() + 1; }
  const Derivatives<Dim>& monomials() const { return basis_.monomials(); }
  /// Factorises the normal equations, or the weighted Vandermonde matrix where those lose too much.
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) at `offset` from the centre, all in units of the stencil radius.
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// Weights of the anchors whose normal equations are well conditioned.
  void fill_batch(const StencilBatch<Dim>& batch, Workspace& work, Weights& weights,
                  std::span<LocalOutcome> outcomes) const;
  /// Bounds of the conditions of the local matrices of some stencils (ConditionBoundsKernel): in
  /// the 1-norm exact to 1e-6 or better.
  void bound_conditions(const Sites<Dim>& sites, std::span<const int> anchors,
                        const Stencils& stencils, int first, Scaling scaling, ConditionNorm norm,
                        Workspace& work, std::span<ConditionBounds> bounds) const;
  /// The matrix A of thesis (3.15): rows are projections on the monomials, columns Taylor terms
  /// (with their factorials), scaled as asked.
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives up to the order of the fit can be given.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;
  /// Fills the monomials at a position: result[a] = z^a.
  void evaluate_monomials(const double* z, double* result) const { basis_.evaluate(z, result); }
  /// Fills T^2 at the nodes, zero at the centre.
  void evaluate_weights(const LocalStencil<Dim>& stencil, std::vector<double>& squared) const;

 private:
  MonomialBasis<Dim> basis_;  ///< without the constant
  std::shared_ptr<const WeightFunction> weight_;

  bool factorise_normal_equations(const LocalStencil<Dim>& stencil, Workspace& work) const;
  bool factorise_qr(const LocalStencil<Dim>& stencil, Workspace& work) const;
};

extern template class TaylorFit<1>;
extern template class TaylorFit<2>;
extern template class TaylorFit<3>;

/// A method made of one Taylor fit.
template <int Dim>
using TaylorMethod = LocalMethod<Dim, TaylorFit<Dim>>;

/// Surplus of the methods that keep stencils small: the thesis' nine nodes in 2D up to order 2,
/// twice the coefficients above it, where fewer are ill-conditioned near boundaries.
inline StencilSurplus lean_surplus(int order) {
  return order <= 2 ? StencilSurplus{1, 1.5, 2} : StencilSurplus{1, 2, 2};
}

/// The stencil rule of those methods: in 1D the neighbours on either side (thesis 2.1.1; the
/// nearest ones may all lie on one side), otherwise the nearest nodes, grown until well conditioned
/// at the orders that the limit was made for.
inline std::string default_lean_stencil(int dim, int order) {
  if (order > 2) return "nearest";
  return dim == 1 ? "star[per_sector=1]" : "grow_until";
}

/// Makes a Taylor-fit method; `name` is used in messages. Stencils are sized by the surplus, but
/// never too small for a flat boundary of a grid.
template <int Dim>
std::unique_ptr<Method<Dim>> make_taylor_method(std::string name, int order,
                                                std::shared_ptr<const WeightFunction> weight,
                                                StencilSurplus surplus,
                                                std::string default_stencil);

}  // namespace strongpoint
