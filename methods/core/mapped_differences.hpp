#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "methods/core/derivatives.hpp"
#include "methods/core/local_method.hpp"

namespace strongpoint {

/// The degree of differences over all nodes of a line.
inline constexpr int whole_line = 0;

/// Finite differences on a block that a smooth map shapes: one-dimensional weights of one degree
/// along the lines of the block, in the coordinates that the nodes have there (IndexBlock::axes),
/// shifted inwards at its ends, and the chain rule
///   u_,a = sum_i x_i,a u_,i    u_,ab = sum_ij x_i,a x_j,b u_,ij + sum_i x_i,ab u_,i
/// whose metric terms x_i,a and x_i,ab are the same differences of the coordinates of the nodes.
/// Smooth functions of the block's coordinates are met to the degree, of polynomials in space only
/// the linear ones. Source: Fornberg 1988 for the weights.
template <int Dim>
class MappedDifferences {
 public:
  static constexpr int most = 16;  ///< degree: beyond it weights at the ends of a line grow

  /// Buffers of one thread.
  struct Workspace {
    std::array<int, Dim> first;              ///< index offset of a line's first node
    std::array<Eigen::MatrixXd, Dim> lines;  ///< (3, n) weights of orders 0 to 2 along each axis
    std::vector<double> axis;                ///< coordinates of a line's nodes
    std::vector<int> offsets;                ///< (Dim, n) index offsets from the centre
    Eigen::MatrixXd weights;                 ///< (derivatives up to order 2 but the value, n)
  };

  /// Throws UsageError when the degree is neither `whole_line` nor within 2 to `most`.
  explicit MappedDifferences(int degree);

  /// Nodes along each axis that this takes, 3 at least for a whole line.
  int width() const { return degree_ == whole_line ? 3 : degree_ + 1; }
  int needed_nodes() const;
  LocalOutcome factorise(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// Away from the anchor by Taylor's formula of degree 2.
  void evaluate(const LocalStencil<Dim>& stencil, Workspace& work, const Point<Dim>& offset,
                const Derivatives<Dim>& derivatives, Eigen::Map<Eigen::MatrixXd> weights) const;
  /// The Jacobian x_i,a, its columns of unit length unless rows only are scaled.
  Eigen::MatrixXd local_matrix(const LocalStencil<Dim>& stencil, Scaling scaling) const;
  /// Derivatives up to order 2 can be given.
  std::string unsupported(const Derivatives<Dim>& derivatives) const;

 private:
  using Matrix = Eigen::Matrix<double, Dim, Dim>;

  int degree_;
  Derivatives<Dim> terms_ = Derivatives<Dim>::between_orders(1, 2);

  /// Finds offsets and lines. False when the stencil holds no full index block, or too small a one.
  bool find_lines(const LocalStencil<Dim>& stencil, Workspace& work) const;
  /// The difference D^alpha of a node.
  double difference(const Workspace& work, int node, const MultiIndex<Dim>& alpha) const;
  /// Differences of the coordinates, (i, a) = x_i,a.
  Matrix jacobian_of(const LocalStencil<Dim>& stencil, const Workspace& work) const;
};

extern template class MappedDifferences<1>;
extern template class MappedDifferences<2>;
extern template class MappedDifferences<3>;

}  // namespace strongpoint
