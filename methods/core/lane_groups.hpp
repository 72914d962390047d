#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "methods/core/local_stencil.hpp"
#include "methods/core/simd/path.hpp"
#include "methods/core/simd/stencil_table.hpp"
#include "methods/core/size_order.hpp"
#include "methods/core/stencil_batch.hpp"

namespace strongpoint {

/// Puts anchors whose stencils are of about the same size side by side, as many as the path has
/// lanes.
class LaneGroups {
 public:
  /// Calls treat(table) with groups of the anchors that accept(anchor) lets pass; it returns the
  /// bits of the lanes that were served, whose outcomes become ok.
  template <int Dim, class Accept, class Treat>
  void each(const StencilBatch<Dim>& batch, Accept accept, Treat treat,
            std::span<LocalOutcome> outcomes) {
    order_.begin(batch.anchors.size());
    for (std::size_t i = 0; i < batch.anchors.size(); ++i) {
      const int anchor = batch.anchors[i];
      const int size = static_cast<int>(batch.stencils[anchor].size());
      if (accept(anchor)) order_.add(size, static_cast<int>(i));
    }
    const std::span<const SizeOrder::Entry> ordered = order_.arrange();
    const std::size_t lanes = lanes_of(simd_path());
    for (std::size_t begin = 0; begin < ordered.size(); begin += lanes) {
      const std::size_t end = std::min(begin + lanes, ordered.size());
      chosen_.clear();
      for (std::size_t i = begin; i < end; ++i) {
        chosen_.push_back(batch.anchors[ordered[i].place]);
      }
      const unsigned served = treat(
          StencilTable{batch.sites.nodes.data(), batch.sites.anchors.data(),
                       batch.stencils.offsets.data(), batch.stencils.nodes.data(), chosen_.data(),
                       static_cast<int>(chosen_.size()), ordered[end - 1].size});
      for (std::size_t i = begin; i < end; ++i) {
        if ((served >> (i - begin) & 1U) != 0) outcomes[ordered[i].place] = LocalOutcome::ok;
      }
    }
  }

 private:
  SizeOrder order_;
  std::vector<int> chosen_;
};

}  // namespace strongpoint
