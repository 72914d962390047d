#pragma once

#include <span>
#include <vector>

#include "methods/core/derivatives.hpp"
#include "methods/core/lane_groups.hpp"
#include "methods/core/monomial_numbers.hpp"
#include "methods/core/simd/gather_kernel.hpp"
#include "methods/core/simd/lane_array.hpp"
#include "methods/core/simd/moving_kernel.hpp"
#include "methods/core/weight_function.hpp"
#include "methods/core/weights.hpp"

namespace strongpoint {

/// What makes a polynomial fit whose value is unknown.
template <int Dim>
struct MovingParts {
  const Derivatives<Dim>& monomials;  ///< with the constant
  const Derivatives<Dim>& known;      ///< derivatives that have to be found, by order
  std::span<const WindowProduct> products;
  std::span<const int> product_offsets;       ///< (known + 1)
  const SmoothingProfile* profile = nullptr;  ///< of a window that moves with the point
  bool uses_volumes = false;                  ///< they multiply the window
  const WeightFunction* weight = nullptr;     ///< the fixed window, null for ones
  double least_distance = 0;                  ///< where it is read
};

/// Polynomial fits of many anchors side by side, with the buffers of one thread.
template <int Dim>
class MovingBatch {
 public:
  /// Writes the weights of all points of the anchors whose moment matrices are well conditioned at
  /// each, and sets their outcomes to ok.
  void fill(const MovingParts<Dim>& parts, const StencilBatch<Dim>& batch, Weights& weights,
            std::span<LocalOutcome> outcomes);

 private:
  MonomialNumbers<Dim> numbers_;
  LaneGroups groups_;
  std::vector<int> asked_;
  LaneArray scratch_, z_, rho_, radius_, squared_;

  /// The fixed window at the nodes of a group.
  const double* weigh(const MovingParts<Dim>& parts, const StencilTable& table);
};

extern template class MovingBatch<1>;
extern template class MovingBatch<2>;
extern template class MovingBatch<3>;

}  // namespace strongpoint
