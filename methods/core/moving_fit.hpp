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
#include "methods/core/radial_derivative.hpp"
#include "methods/core/stencil_kernel.hpp"

namespace strongpoint {

/// What of a shape function phi_j(x) = r(x).p(x_j) w_j(x) is differentiated.
enum class Differentiation {
  full,    ///< everything: derivatives of the shape functions
  diffuse  ///< the polynomial only, the window held fixed: derivatives of the local fit
};

/// What a node's window is multiplied by.
enum class NodeMeasure { one, volume };

/// Shape functions of the polynomial fit whose window moves with the point of evaluation:
/// phi_j(x) = r(x).p(x_j) w_j(x), A(x) r(x) = p(x), A = sum_j w_j(x) p(x_j) p(x_j)^T,
/// w_j(x) = W((x - x_j)/h) times the node's measure, h fixed at the anchor. Derivatives by
/// Leibniz' rule: A r^(alpha) = p^(alpha) - sum_(0<beta<=alpha) C(alpha,beta) A^(beta)
/// r^(alpha-beta). They are computed in the polynomials that are orthonormal under w(x), in which A
/// is the identity, so that a high degree costs the condition of the QR and not its square.
/// Source: Lancaster & Salkauskas 1981 (thesis (1.22)-(1.26)); Nayroles, Touzot, Villon 1992 for
/// diffuse derivatives; Liu, Jun, Zhang 1995 with volumes.
template <int Dim>
class MovingFit {
 public:
  /// One product of Leibniz' rule: C(alpha, beta) w^(beta) f^(alpha - beta).
  struct Product {
    int window;    ///< position of beta
    int function;  ///< position of alpha - beta
    double binomial;
  };
  /// A derivative that has to be known, with the products that its rule takes.
  struct Step {
    MultiIndex<Dim> alpha;
    std::vector<Product> products;  ///< the last one is w times f^(alpha)
    RadialDerivative<Dim> window;
  };
  /// Buffers of one thread.
  struct Workspace {
    HouseholderQr qr;                       ///< of the monomials under the window at `place`
    Point<Dim> place = Point<Dim>::Zero();  ///< offset of `qr` from the anchor, NaN without one
    Derivatives<Dim> prepared;              ///< the derivatives that `steps` belongs to
    Derivatives<Dim> known;                 ///< alpha of each step, none before the ones it takes
    std::vector<Step> steps;                ///< one for each of `known`
    std::vector<double> kernel;             ///< derivatives of W in the squared distance
    std::vector<double> squared;            ///< (n) w at `place`
    std::vector<double> basis;              ///< (m, n) orthonormal polynomials at the nodes
    std::vector<double> windows;            ///< (n, steps) derivatives of w
    std::vector<double> functions;          ///< (n, steps) derivatives of r.p(x_j)
    std::vector<double> polynomial;         ///< (m) derivative of r
    std::vector<WindowProduct> products;    ///< those of the steps but the last ones, for the batch
    std::vector<int> product_offsets;       ///< (steps + 1)
    MovingBatch<Dim> batch;
  };

  MovingFit(int degree, StencilKernel<Dim> kernel, Differentiation differentiation,
            NodeMeasure measure)
      : basis_(0, degree),
        kernel_(std::move(kernel)),
        differentiation_(differentiation),
        measure_(measure),
        profile_(kernel_.profile()) {}

  const StencilKernel<Dim>& kernel() const { return kernel_; }
  NodeMeasure measure() const { return measure_; }
  int degree() const { return basis_.degree(); }
  int needed_nodes() const { return basis_.terms(); }
  /// Factorises the fit at the anchor.
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) at `offset` from the anchor, all in units of the stencil radius;
  /// `singular` where the window sees too few nodes there.
  LocalOutcome evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                        const Derivatives<Dim>& derivatives,
                        Eigen::Map<Eigen::MatrixXd> weights) const;
  /// Weights of the anchors whose normal equations are well conditioned at all their points.
  void fill_batch(const StencilBatch<Dim>& batch, Workspace& work, Weights& weights,
                  std::span<LocalOutcome> outcomes) const;
  /// The matrix A at the anchor, its columns Taylor terms (with their factorials).
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Full derivatives as far as the kernel is smooth, diffuse ones up to the degree.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  MonomialBasis<Dim> basis_;
  StencilKernel<Dim> kernel_;
  Differentiation differentiation_;
  NodeMeasure measure_;
  SmoothingProfile profile_;

  void evaluate_windows(const LocalStencil<Dim>& stencil, const Point<Dim>& offset,
                        std::vector<double>& squared) const;
  LocalOutcome factorise_at(const LocalStencil<Dim>& stencil, const Point<Dim>& offset,
                            Workspace& work) const;
  void prepare(const Derivatives<Dim>& derivatives, Workspace& work) const;
  /// Fills what the batch reads of the steps.
  void list_products(Workspace& work) const;
  void differentiate_windows(const LocalStencil<Dim>& stencil, const Point<Dim>& offset,
                             Workspace& work) const;
  void differentiate_functions(const LocalStencil<Dim>& stencil, const Point<Dim>& offset,
                               Workspace& work) const;
};

extern template class MovingFit<1>;
extern template class MovingFit<2>;
extern template class MovingFit<3>;

/// Makes a method of one moving fit; `name` is used in messages. Its stencils hold all nodes within
/// the support of the kernel, and never fewer than twice as many as there are monomials.
template <int Dim>
std::unique_ptr<Method<Dim>> make_moving_method(std::string name, MovingFit<Dim> fit);

/// Radius of the support over the local spacing that suits a degree: the polynomials of a degree
/// need as many lines of nodes at a flat boundary, and the window must not vanish at the last.
/// Degree 2 has 3.2 spacings; in 3D 2.6, with which collocation converges where it does not with
/// 3.2 (poisson_cube on perturbed nodes), at half the cost.
inline double suitable_support(int dim, int degree) {
  return (degree > 1 ? degree : 1) + (dim == 3 ? 0.6 : 1.2);
}

/// The option `h` of a method whose support follows the degree unless a length is given.
inline OptionDoc suitable_length_option() {
  return {
      "h", "",
      "smoothing length over the local spacing (the support is 2.6 h with gauss, else 2 h); when "
      "not given, the support is the degree + 1.2 spacings, + 0.6 in 3D"};
}

}  // namespace strongpoint
