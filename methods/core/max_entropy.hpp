#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/entropy_fit.hpp"
#include "methods/core/local_method.hpp"

namespace strongpoint {

/// What stands at the ends of a 1D cloud.
enum class MaxEntropyBoundary {
  hull,    ///< the max-ent functions of the face on which a point lies
  bspline  ///< B-splines, blended with the max-ent functions inside
};

/// The parameters of maximum-entropy functions, all dimensionless.
struct MaxEntropyOptions {
  int order = 1;       ///< of the moments that are prescribed, 1 or 2
  double beta = 0.8;   ///< locality beta h^2 of order 1, h being the local spacing
  double gap = 0.6;    ///< variance over h^2 of order 2; in 1D h is the widest gap of the stencil
  double inset = 0.5;  ///< how far inside a boundary point's derivatives are taken
  MaxEntropyBoundary boundary = MaxEntropyBoundary::hull;

  /// Of the functions of order 1, which stand on the hull with order 2 as well: there the bell that
  /// has the gap as its variance.
  double locality() const { return order == 1 ? beta : 1 / (2 * gap); }
};

/// How the means of S statistics move with the point: their first and second derivatives.
template <int Dim, int S>
struct MeanRates {
  Eigen::Matrix<double, S, Dim> first = Eigen::Matrix<double, S, Dim>::Zero();
  /// Column i Dim + j holds the derivative by x_i and x_j.
  Eigen::Matrix<double, S, Dim* Dim> second = Eigen::Matrix<double, S, Dim * Dim>::Zero();
};

/// Maximum-entropy functions on a stencil, with one locality (order 1) or gap (order 2) for the
/// whole stencil.
///
/// Order 1: sum p = 1, sum p x_a = x, prior exp(-beta |x - x_a|^2). A point on the boundary of the
/// stencil's convex hull has the functions of its face (weak Kronecker delta); a point outside has
/// none and is refused. Source: Arroyo & Ortiz 2006; thesis (1.38)-(1.46).
///
/// Order 2: also sum p (x_a - x)(x_a - x)^T = g, no prior, so that derivatives (not values) of
/// quadratics are exact where g is constant. Source: Cyron, Arroyo & Ortiz 2009; thesis
/// (1.47)-(1.58). In 1D g = G = gap h^2, h being the widest gap of the stencil, and at a distance
/// xi below l from the end of the hull G (1 - (1 - xi/l)^2), with l = h/2 or the distance of the
/// second node if that is less. (1.51) has gap = 1/4 and stretches its ramp over the first
/// interval, at whose end it falls back to zero; ending halfway it is continuously differentiable,
/// and any gap above 1/4 can be attained everywhere (xi (h - xi) is the least, with two nodes). In
/// 2D g = G I with the local spacing h; where no distribution attains it, other gaps are tried, and
/// in the end the functions of order 1 stand for the values. In 3D it is not offered.
///
/// Boundary `bspline`, 1D: the first two cubic B-splines of an open knot vector stand for the two
/// nodes at an end, and the max-ent functions of the others for the rest: their sum and mean are
/// one and x less the B-splines' contributions. Source: Rosolen & Arroyo 2013, who blend functions
/// of order 1; thesis 1.3.3. With order 2 the variance about that mean is G: the gap is what
/// results.
///
/// Derivatives follow from implicit differentiation ((1.57), once more for the second). On the hull
/// the second normal derivative has no limit, nor the first a useful one (that of the single node
/// nearest to the face), so that all derivatives there are those of a point a little inside:
/// towards the prior's mean by `inset` times its distance with order 1, an error of O(h) with
/// constants below one; about one spacing inside with order 2, whose first derivatives are carried
/// back along the second ones and stay exact for quadratics.
template <int Dim>
class MaxEntropy {
 public:
  /// Statistics of order 2; 3D is not offered.
  static constexpr int moments = Dim == 1 ? 2 : Dim == 2 ? 5 : 3;

  /// Buffers of one thread.
  struct Workspace {
    EntropyFit<Dim> linear;
    EntropyFit<moments> quadratic;
    std::vector<double> row;               ///< (n) weights of one derivative
    std::vector<double> positions;         ///< (n) ascending, in 1D
    double widest = 0;                     ///< widest gap of the stencil in spacings, in 1D
    double left_ramp = 0, right_ramp = 0;  ///< lengths of the gap's ramps in spacings, in 1D
  };

  explicit MaxEntropy(const MaxEntropyOptions& options) : options_(options) {}

  /// As many as there are constraints, and two more for the B-splines of a blend.
  int needed_nodes() const {
    return (options_.order == 1 ? Dim + 1 : moments + 1) +
           (options_.boundary == MaxEntropyBoundary::bspline ? 2 : 0);
  }
  /// Checks that the nodes span the space; everything else depends on the point.
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) at `offset` from the anchor, all in units of the stencil radius;
  /// `infeasible` when no distribution has the moments.
  LocalOutcome evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                        const Derivatives<Dim>& derivatives,
                        Eigen::Map<Eigen::MatrixXd> weights) const;
  /// Covariance of the nodes under the prior at the anchor: the Hessian where Newton's method
  /// starts.
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives up to the second can be given.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  MaxEntropyOptions options_;

  EntropyOutcome solve_linear(const LocalStencil<Dim>& stencil, Workspace& work,
                              const Point<Dim>& at) const;
  double solve_quadratic(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& at,
                         double factor, MeanRates<Dim, moments>& rates) const;
  bool solve_relaxed(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& at,
                     std::span<const Point<Dim>> shifts, Point<Dim>& shift,
                     MeanRates<Dim, moments>& rates) const;
  Point<Dim> prior_mean(const LocalStencil<Dim>& stencil, const Point<Dim>& at) const;
  LocalOutcome evaluate_order_1(const LocalStencil<Dim>& stencil, Workspace& work,
                                const Point<Dim>& at, const Derivatives<Dim>& derivatives,
                                Eigen::Map<Eigen::MatrixXd> weights) const;
  LocalOutcome evaluate_order_2(const LocalStencil<Dim>& stencil, Workspace& work,
                                const Point<Dim>& at, const Derivatives<Dim>& derivatives,
                                Eigen::Map<Eigen::MatrixXd> weights) const;
  LocalOutcome evaluate_order_1_or_2(const LocalStencil<Dim>& stencil, Workspace& work,
                                     const Point<Dim>& at, const Derivatives<Dim>& derivatives,
                                     Eigen::Map<Eigen::MatrixXd> weights) const;
  LocalOutcome evaluate_blend(const LocalStencil<Dim>& stencil, Workspace& work,
                              const Point<Dim>& at, const Derivatives<Dim>& derivatives,
                              Eigen::Map<Eigen::MatrixXd> weights) const;
};

extern template class MaxEntropy<1>;
extern template class MaxEntropy<2>;
extern template class MaxEntropy<3>;

}  // namespace strongpoint
