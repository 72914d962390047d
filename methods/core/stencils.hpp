#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/core/large_array.hpp"

namespace strongpoint {

/// The nodes used at each anchor, in compressed rows. Each stencil is sorted by (distance, node
/// id); an anchor that needs no derivative has an empty one.
struct Stencils {
  std::vector<std::int64_t> offsets{0};  ///< (anchors + 1)
  LargeArray<int> nodes;                 ///< (entries)

  int size() const { return static_cast<int>(offsets.size()) - 1; }
  std::span<const int> operator[](int anchor) const {
    return {nodes.data() + offsets[anchor], nodes.data() + offsets[anchor + 1]};
  }
  /// The anchors whose stencils are not empty, ascending.
  std::vector<int> occupied() const {
    std::vector<int> anchors;
    anchors.reserve(offsets.size());
    for (int anchor = 0; anchor < size(); ++anchor) {
      if (offsets[anchor + 1] > offsets[anchor]) anchors.push_back(anchor);
    }
    return anchors;
  }
  /// Appends the stencil of the next anchor.
  void push_back(std::span<const int> stencil) {
    nodes.insert(nodes.end(), stencil.begin(), stencil.end());
    offsets.push_back(static_cast<std::int64_t>(nodes.size()));
  }
};

}  // namespace strongpoint
