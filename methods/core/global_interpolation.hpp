#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "methods/core/method.hpp"
#include "methods/core/radial_interpolation.hpp"

namespace strongpoint {

/// One radial interpolation on all nodes. The matrix is factorised once; a row of weights holds
/// every node, sorted by (distance from the anchor, node id). Cost: N^3 / 3 and 2 N^2 a derivative
/// of a point, for N nodes.
template <int Dim>
class GlobalInterpolation final : public Method<Dim> {
 public:
  /// More nodes are refused: weights of two derivatives then take 3000^2 * 16 bytes, 144 MB.
  static constexpr int most_nodes = 3000;

  GlobalInterpolation(RadialInterpolation<Dim> kernel, std::string name)
      : kernel_(std::move(kernel)), name_(std::move(name)) {}

  Needs needs() const override { return {.spacing = kernel_.uses_spacing()}; }
  Promises promises() const override {
    return {.reproduces = kernel_.degree(),
            .scale_covariant = !kernel_.shape().is_fixed(),
            .interpolates = true,
            .local = false};
  }
  int stencil_size() const override { return kernel_.needed_nodes(); }
  std::string default_stencil() const override { return every_node; }
  std::string unsupported(const Derivatives<Dim>& derivatives) const override {
    return kernel_.unsupported(derivatives);
  }
  /// Weights of the points whose anchor is wanted. Throws SkipCase for too many nodes and CaseError
  /// for coincident ones, and for a matrix so ill-conditioned that smooth nodal values are not
  /// given back.
  Weights weights(const Sites<Dim>& sites, const Stencils& stencils,
                  const Derivatives<Dim>& derivatives) const override;
  /// The condition of the one matrix, for every anchor.
  std::vector<double> condition(const Sites<Dim>& sites, std::span<const int> anchors,
                                const Stencils& stencils, Scaling scaling,
                                ConditionNorm norm) const override;

 private:
  /// All nodes as one stencil about the middle of their bounding box.
  struct Whole {
    LocalStencil<Dim> stencil;
    std::vector<int> nodes;  ///< ids, in the order of the matrix
    std::vector<int> place;  ///< of each node in the matrix
    Point<Dim> middle;
  };
  RadialInterpolation<Dim> kernel_;
  std::string name_;

  Whole gather(const Sites<Dim>& sites) const;
  /// Fills derivative d of the functions at some points, a column each, and zeros behind them.
  void fill_right_hand_sides(const Sites<Dim>& sites, const Whole& whole,
                             std::span<const int> points, const Derivatives<Dim>& derivatives,
                             int d, typename RadialInterpolation<Dim>::Workspace& work,
                             Eigen::MatrixXd& right) const;
};

extern template class GlobalInterpolation<1>;
extern template class GlobalInterpolation<2>;
extern template class GlobalInterpolation<3>;

}  // namespace strongpoint
