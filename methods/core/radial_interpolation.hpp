#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/local_solvers.hpp"
#include "methods/core/radial_derivative.hpp"
#include "methods/core/radial_function.hpp"

namespace strongpoint {

/// The shape parameter c of a radial function: a multiple of the local spacing, or a fixed length.
class RadialShape {
 public:
  /// Reads the options `shape` and `shape_length`. Throws UsageError when both are given.
  explicit RadialShape(const Options& options);

  /// True when the parameter is the same at any spacing.
  bool is_fixed() const { return length_ > 0; }
  /// The parameter in units of the stencil radius.
  template <int Dim>
  double over_radius(const LocalStencil<Dim>& stencil) const {
    return is_fixed() ? length_ / stencil.radius : factor_ * stencil.spacing;
  }

  /// The options `shape` and `shape_length`.
  static std::vector<OptionDoc> options();

 private:
  double factor_ = 0;  // in local spacings
  double length_ = 0;  // in the problem's unit
};

/// Interpolation by radial functions at the nodes, with or without all polynomials up to a degree:
/// weights w solve [Phi P; P^T 0] [w; .] = [L phi(x - x_j); L p] for each derivative L.
/// Source: thesis (1.30)-(1.36), where (1.32) is sum_h a_h B_h(x_i) + sum_k b_k P_k(x_i) = u_i, the
/// constraints (1.33) sum over the nodes and (1.36) keeps the columns of the nodes. Distances are
/// taken in units of the stencil radius, which matters to r^power log r below degree power/2 only.
template <int Dim>
class RadialInterpolation {
 public:
  /// Buffers of one thread.
  struct Workspace {
    HouseholderQr polynomials;            ///< of the (n, m) polynomial matrix, to judge the nodes
    Lu bordered;                          ///< (n + m, n + m)
    std::vector<double> functions;        ///< (order + 1, n) f and its derivatives by r^2
    std::vector<double> right_hand_side;  ///< (n + m)
    Derivatives<Dim> prepared;            ///< the derivatives that `radials` belongs to
    std::vector<RadialDerivative<Dim>> radials;
  };

  /// Reads the options of RadialFunction and RadialShape; `degree` is -1 without polynomials.
  RadialInterpolation(const Options& options, int degree);

  int degree() const { return degree_; }
  int terms() const { return degree_ < 0 ? 0 : monomials_.size(); }
  int needed_nodes() const { return std::max(2, terms()); }
  const RadialShape& shape() const { return shape_; }
  /// True when the weights depend on the local spacing.
  bool uses_spacing() const { return function_.has_shape() && !shape_.is_fixed(); }
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) at `offset` from the anchor, all in units of the stencil radius.
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// The bordered matrix [Phi P; P^T 0], (n + m, n + m). With scaling by rows alone the polynomials
  /// are in the unit of the problem.
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives that the radial function has everywhere can be given, whatever the degree.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;
  /// Fills the functions of `work` at an offset and makes its derivatives ready.
  void prepare(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
               const Derivatives<Dim>& derivatives) const;
  /// Fills derivative d of the functions and of the polynomials at an offset that was prepared.
  void fill_right_hand_side(const LocalStencil<Dim>& stencil, const Workspace& work,
                            const Point<Dim>& offset, int d, double* result) const;

 private:
  int degree_;
  RadialFunction function_;
  RadialShape shape_;
  Derivatives<Dim> monomials_;

  /// Writes the matrix, (n + m)^2 and symmetric.
  void fill_matrix(const LocalStencil<Dim>& stencil, double* matrix) const;
};

extern template class RadialInterpolation<1>;
extern template class RadialInterpolation<2>;
extern template class RadialInterpolation<3>;

/// All options of a radial interpolation but the degree.
std::vector<OptionDoc> radial_options(const std::string& default_kernel);

/// Makes a local method of a radial interpolation with polynomials up to a degree, -1 for none, on
/// the nearest nodes: 5 in 1D, 15 in 2D, 30 in 3D. `name` is used in messages.
template <int Dim>
std::unique_ptr<Method<Dim>> make_radial_method(std::string name, const Options& options,
                                                int degree);

}  // namespace strongpoint
