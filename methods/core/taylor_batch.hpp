#pragma once

#include <span>
#include <utility>
#include <vector>

#include "methods/core/local_stencil.hpp"
#include "methods/core/monomial_basis.hpp"
#include "methods/core/simd/lane_array.hpp"
#include "methods/core/simd/taylor_kernel.hpp"
#include "methods/core/stencil_batch.hpp"
#include "methods/core/weight_function.hpp"
#include "methods/core/weights.hpp"

namespace strongpoint {

/// From where on normal equations are left to be treated on their own.
struct TaylorLimits {
  double least_pivot;  ///< over its diagonal entry
  double condition;    ///< in the 1-norm
};

/// Taylor fits of many anchors side by side, with the buffers of one thread.
template <int Dim>
class TaylorBatch {
 public:
  /// True for the orders that kernels are made for; the others are treated one by one.
  static bool serves(int order) { return order >= 1 && order <= (Dim == 3 ? 3 : 4); }

  /// Writes the weights of all points of the anchors whose normal equations are within the limits,
  /// and sets their outcomes to ok. The basis has no constant; the weight sees 1 for distances that
  /// do not count.
  void fill(const MonomialBasis<Dim>& basis, const WeightFunction& weight,
            const TaylorLimits& limits, const StencilBatch<Dim>& batch, Weights& weights,
            std::span<LocalOutcome> outcomes);

 private:
  std::vector<std::pair<int, int>> by_size_;  ///< size of a stencil, its place in the batch
  std::vector<int> chosen_;
  LaneArray z_, rho_, squared_, radius_, scratch_;
  std::vector<unsigned> faulty_, done_;
  Derivatives<Dim> derivatives_;  ///< those that the next three belong to
  std::vector<int> orders_, powers_;
  std::vector<double> factors_;

  void sort_by_size(const StencilBatch<Dim>& batch, int needed);
  void tabulate(const MonomialBasis<Dim>& basis, const Derivatives<Dim>& derivatives);
  GatherTask gather(const StencilBatch<Dim>& batch, const WeightFunction& weight,
                    std::span<const std::pair<int, int>> part);
  void weigh(const StencilBatch<Dim>& batch, const WeightFunction& weight, const GatherTask& task);
};

extern template class TaylorBatch<1>;
extern template class TaylorBatch<2>;
extern template class TaylorBatch<3>;

}  // namespace strongpoint
