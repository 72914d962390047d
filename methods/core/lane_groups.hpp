#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "methods/core/local_stencil.hpp"
#include "methods/core/simd/path.hpp"
#include "methods/core/simd/stencil_table.hpp"
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
    by_size_.clear();
    for (std::size_t i = 0; i < batch.anchors.size(); ++i) {
      const int anchor = batch.anchors[i];
      const int size = static_cast<int>(batch.stencils[anchor].size());
      if (accept(anchor)) by_size_.emplace_back(size, static_cast<int>(i));
    }
    std::sort(by_size_.begin(), by_size_.end());
    const std::size_t lanes = lanes_of(simd_path());
    for (std::size_t begin = 0; begin < by_size_.size(); begin += lanes) {
      const std::size_t end = std::min(begin + lanes, by_size_.size());
      chosen_.clear();
      for (std::size_t i = begin; i < end; ++i) {
        chosen_.push_back(batch.anchors[by_size_[i].second]);
      }
      const unsigned served = treat(
          StencilTable{batch.sites.nodes.data(), batch.sites.anchors.data(),
                       batch.stencils.offsets.data(), batch.stencils.nodes.data(), chosen_.data(),
                       static_cast<int>(chosen_.size()), by_size_[end - 1].first});
      for (std::size_t i = begin; i < end; ++i) {
        if ((served >> (i - begin) & 1U) != 0) outcomes[by_size_[i].second] = LocalOutcome::ok;
      }
    }
  }

 private:
  std::vector<std::pair<int, int>> by_size_;  ///< size of a stencil, its place in the batch
  std::vector<int> chosen_;
};

}  // namespace strongpoint
