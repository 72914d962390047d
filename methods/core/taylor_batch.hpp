#pragma once

#include <span>
#include <vector>

#include "methods/core/condition.hpp"
#include "methods/core/local_stencil.hpp"
#include "methods/core/monomial_basis.hpp"
#include "methods/core/simd/lane_array.hpp"
#include "methods/core/simd/taylor_kernel.hpp"
#include "methods/core/size_order.hpp"
#include "methods/core/stencil_batch.hpp"
#include "methods/core/weight_function.hpp"
#include "methods/core/weights.hpp"

namespace strongpoint {

/// From where on normal equations are left to be treated on their own.
struct TaylorLimits {
  double least_pivot;  ///< over its diagonal entry
  double condition;    ///< in the 1-norm
};

/// What makes a Taylor fit.
template <int Dim>
struct TaylorParts {
  const MonomialBasis<Dim>& basis;  ///< without the constant
  const WeightFunction& weight;
  TaylorLimits limits;
};

/// Taylor fits of many anchors side by side, with the buffers of one thread.
template <int Dim>
class TaylorBatch {
 public:
  /// True for the orders that kernels are made for; the others are treated one by one.
  static bool serves(int order) { return order >= 1 && order <= (Dim == 3 ? 3 : 4); }

  /// Writes the weights of all points of the anchors whose normal equations are within the limits,
  /// and sets their outcomes to ok.
  void fill(const TaylorParts<Dim>& fit, const StencilBatch<Dim>& batch, Weights& weights,
            std::span<LocalOutcome> outcomes);
  /// Bounds the conditions of local matrices scaled as asked; stencil first + i belongs to
  /// anchors[i]. What is beyond the limits keeps its bounds.
  void judge(const TaylorParts<Dim>& fit, const Sites<Dim>& sites, std::span<const int> anchors,
             const Stencils& stencils, int first, Scaling scaling, ConditionNorm norm,
             std::span<ConditionBounds> bounds);

 private:
  SizeOrder order_;
  std::vector<int> chosen_, stencil_of_place_;
  LaneArray z_, rho_, squared_, scratch_, one_, maximum_;
  std::vector<unsigned> done_;
  std::vector<double> origins_;   ///< (Dim, places) anchors that are judged
  Derivatives<Dim> derivatives_;  ///< those that the next three belong to
  std::vector<int> orders_, powers_, own_;
  std::vector<double> factors_;

  /// The stencils of at least `needed` nodes, the anchor the first, by their sizes.
  std::span<const SizeOrder::Entry> ordered(const Sites<Dim>& sites, std::span<const int> anchors,
                                            const Stencils& stencils, int needed);
  /// Calls treat(part, size) with parts of what is ordered that share a size, padded.
  template <class Treat>
  static void each_part(std::span<const SizeOrder::Entry> ordered, Treat treat);
  void tabulate(const MonomialBasis<Dim>& basis, const Derivatives<Dim>& derivatives);
  /// What kernels read of the stencils of `chosen_`, whose sizes are `size` at most, with room for
  /// what they gather.
  TaylorStencils prepare(const TaylorParts<Dim>& fit, const Sites<Dim>& sites,
                         const double* anchors, const std::int64_t* offsets, const int* ids,
                         int size);
};

extern template class TaylorBatch<1>;
extern template class TaylorBatch<2>;
extern template class TaylorBatch<3>;

}  // namespace strongpoint
