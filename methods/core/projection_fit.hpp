#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/local_solvers.hpp"
#include "methods/core/projection_batch.hpp"

namespace strongpoint {

/// Fills the values of projection functions at the nodes of a stencil, (functions, n), node after
/// node; where the projections are sums over cells, times the cells' volumes. Allocates nothing.
template <int Dim>
using Projections = std::function<void(const LocalStencil<Dim>& stencil, double* values)>;

/// The Taylor series about the anchor, cut after some terms and projected on as many functions: the
/// derivatives solve A c = b with A_rs = sum_j P_r(x_j) (x_j - x_i)^s / s!, b_r = sum_j P_r(x_j)
/// u_j. Terms are solved for in blocks, one after the other, a block taking the derivatives found
/// before it to its right-hand side. A block that does not solve for the value takes it from the
/// node at the anchor: its b projects u_j - u_i.
/// Source: MSPH (Zhang & Batra 2004; thesis (1.19)-(1.21)) is one block with the value, CSPM (Chen,
/// Beraun, Carney 1999; thesis (1.17), (1.18)) a block for each order, MFPM in 1D with other
/// projection functions than the monomials (thesis 4.4.2) one block without the value.
template <int Dim>
class ProjectionFit {
 public:
  /// Buffers of one thread.
  struct Workspace {
    std::vector<double> projections;   ///< (terms, n)
    std::vector<double> powers;        ///< (terms) z^s at a node
    std::vector<double> moments;       ///< (terms, terms) row after row, sum_j P_r(z_j) z_j^s
    std::vector<double> coefficients;  ///< (terms, n) of the Taylor terms, node after node
    std::vector<double> nodal;         ///< (terms) what the value at the anchor is projected with
    Lu lu;
    ProjectionBatch<Dim> batch;
  };

  /// The terms of each block, and one projection function for each term in their order. When these
  /// are the derivatives of a smoothing kernel and the terms all up to order 2, `profile` lets
  /// stencils be treated side by side.
  ProjectionFit(const std::vector<Derivatives<Dim>>& blocks, Projections<Dim> projections,
                std::optional<SmoothingProfile> profile = std::nullopt);

  /// Number of Taylor terms, of all blocks.
  int terms() const { return terms_.size(); }
  int needed_nodes() const;
  /// True when some block takes the value from the node at the anchor.
  bool needs_centre() const { return needs_centre_; }
  /// Coefficients of all Taylor terms, block by block.
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) of the Taylor polynomial at `offset` from the anchor.
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// Weights of the anchors whose systems are well conditioned, as far as a profile was given.
  void fill_batch(const StencilBatch<Dim>& batch, Workspace& work, Weights& weights,
                  std::span<LocalOutcome> outcomes) const;
  /// The matrix A of all blocks, block lower triangular; scaled as asked.
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives that are among the terms can be given, and the value.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  Derivatives<Dim> terms_;
  std::vector<int> block_end_;  ///< of each term, one past the last term of its block
  std::vector<int> is_nodal_;   ///< of each term, 1 when its block takes the value from the node
  bool needs_centre_ = false;
  Projections<Dim> projections_;
  std::optional<SmoothingProfile> profile_;

  /// Fills projections and moments; a moment that a block does not use is zero.
  void project(const LocalStencil<Dim>& stencil, Workspace& work) const;
};

extern template class ProjectionFit<1>;
extern template class ProjectionFit<2>;
extern template class ProjectionFit<3>;

/// A method made of one projection fit.
template <int Dim>
using ProjectionMethod = LocalMethod<Dim, ProjectionFit<Dim>>;

}  // namespace strongpoint
