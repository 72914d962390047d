#pragma once

#include <span>
#include <vector>

#include "methods/core/derivatives.hpp"
#include "methods/core/lane_groups.hpp"
#include "methods/core/monomial_numbers.hpp"
#include "methods/core/simd/lane_array.hpp"
#include "methods/core/simd/smoothing_profile.hpp"
#include "methods/core/weights.hpp"

namespace strongpoint {

/// What makes a projection of Taylor series on a smoothing kernel and its derivatives.
template <int Dim>
struct ProjectionParts {
  const Derivatives<Dim>& terms;  ///< all of orders 0 or 1 to 2
  std::span<const int> block_end;
  std::span<const int> is_nodal;
  int needed_nodes;
  bool needs_centre;
  const SmoothingProfile& profile;
};

/// Projections of the Taylor series at many anchors side by side, with the buffers of one thread.
template <int Dim>
class ProjectionBatch {
 public:
  /// Writes the weights of all points of the anchors whose systems are well conditioned without
  /// exchanges, and sets their outcomes to ok.
  void fill(const ProjectionParts<Dim>& parts, const StencilBatch<Dim>& batch, Weights& weights,
            std::span<LocalOutcome> outcomes);

 private:
  MonomialNumbers<Dim> numbers_;
  LaneGroups groups_;
  LaneArray scratch_;
};

extern template class ProjectionBatch<1>;
extern template class ProjectionBatch<2>;
extern template class ProjectionBatch<3>;

}  // namespace strongpoint
