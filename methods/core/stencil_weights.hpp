#pragma once

#include <algorithm>

#include "methods/core/sites.hpp"
#include "methods/core/stencils.hpp"
#include "methods/core/weights.hpp"

namespace strongpoint {

/// An empty pattern for the weights of all points: each row is the stencil of the point's anchor.
template <int Dim>
Weights weights_on_stencils(const Sites<Dim>& sites, const Stencils& stencils, int per_entry) {
  Weights weights;
  weights.per_entry = per_entry;
  const int count = sites.point_count();
  weights.offsets.assign(sites.point_anchor.size() + 1, 0);
  for (int p = 0; p < count; ++p) {
    const std::int64_t* const list = stencils.offsets.data() + sites.point_anchor[p];
    weights.offsets[p + 1] = weights.offsets[p] + list[1] - list[0];
  }
  weights.columns.resize(weights.offsets.back());
  constexpr int at_once = 256;
#pragma omp parallel for schedule(static)
  for (int begin = 0; begin < count; begin += at_once) {
    const int end = std::min(count - begin, at_once) + begin;
    for (int p = begin, next = p; p < end; p = next) {
      const int anchor = sites.point_anchor[p];
      do {
        ++next;  // stencils of anchors in a row lie in one piece
      } while (next < end && sites.point_anchor[next] == anchor + next - p);
      const auto* const nodes = stencils.nodes.data();
      std::copy(nodes + stencils.offsets[anchor], nodes + stencils.offsets[anchor + next - p],
                weights.columns.begin() + weights.offsets[p]);
    }
  }
  weights.values.resize(weights.offsets.back() * per_entry);
  return weights;
}

}  // namespace strongpoint
