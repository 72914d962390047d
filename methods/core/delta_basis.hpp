#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"
#include "methods/core/local_solvers.hpp"

namespace strongpoint {

/// Interpolation by delta basis functions, local on a stencil: products over the coordinates of
/// phi(t, s) = sum_n lambda_n sin(n pi (t + 1)/2) sin(n pi (s + 1)/2), n = 1 to M, with
/// lambda_n = (1 - (n/(M + 1))^2)^k, one at each node s. Sources: Hon & Yang 2009, thesis (1.37);
/// the map of each coordinate's range onto [-1/2, 1/2], here that of the stencil's bounding box, is
/// Reutskiy's (2005). Products in more than one dimension are ours; the thesis gives one.
template <int Dim>
class DeltaBasis {
 public:
  /// Buffers of one thread.
  struct Workspace {
    Point<Dim> middle, size;              ///< the bounding box, over the stencil radius
    std::vector<double> sines;            ///< (M, Dim, n) sin(n pi (s + 1)/2) at the nodes
    std::vector<double> factor;           ///< (order + 1, Dim, n) derivatives of phi at a point
    std::vector<double> right_hand_side;  ///< (n)
    Lu matrix;                            ///< (n, n)
  };

  /// Highest order of a derivative that is offered.
  static constexpr int highest_order = 8;

  /// `sines` is M, `regularity` is k.
  DeltaBasis(int sines, int regularity);

  int needed_nodes() const { return 2; }
  /// `singular` where all nodes share a coordinate, `flat` where M sines cannot tell them apart.
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Weights (derivatives, n) at `offset` from the anchor, all in units of the stencil radius.
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// The interpolation matrix, (n, n), whatever the scaling.
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  std::vector<double> lambda_;  ///< (M)

  int sines() const { return static_cast<int>(lambda_.size()); }
  /// Finds the bounding box and the sines at the nodes. False when the box has no extent.
  bool prepare(const LocalStencil<Dim>& stencil, Workspace& work) const;
  void fill_matrix(const LocalStencil<Dim>& stencil, const Workspace& work, double* matrix) const;
};

extern template class DeltaBasis<1>;
extern template class DeltaBasis<2>;
extern template class DeltaBasis<3>;

}  // namespace strongpoint
