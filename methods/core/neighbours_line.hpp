#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "methods/core/neighbours_collectors.hpp"

namespace strongpoint {

/// Nodes on a line in ascending order: a query looks to both sides, the nearer node first.
template <int Dim>
class LineEngine {
 public:
  static_assert(Dim == 1);

  explicit LineEngine(const Points<1>& nodes) : ids_(static_cast<std::size_t>(nodes.cols())) {
    std::iota(ids_.begin(), ids_.end(), 0);
    std::sort(ids_.begin(), ids_.end(), [&](int a, int b) {
      return nodes(0, a) < nodes(0, b) || (nodes(0, a) == nodes(0, b) && a < b);
    });
    places_.reserve(ids_.size());
    for (int id : ids_) places_.push_back(nodes(0, id));
  }

  /// Offers all nodes within the collector's bound.
  void visit(const Point<1>& query, CandidateCollector auto& collector) const {
    const auto middle = std::lower_bound(places_.begin(), places_.end(), query[0]);
    std::size_t right = middle - places_.begin();
    std::size_t left = right;  // one above the next node to the left
    const auto square = [&](std::size_t i) {
      return squared_distance<1>(query, Point<1>(places_[i]));
    };
    while (left > 0 || right < places_.size()) {
      const bool go_left =
          right == places_.size() || (left > 0 && square(left - 1) <= square(right));
      const std::size_t next = go_left ? --left : right++;
      const double d2 = square(next);
      if (d2 > collector.bound()) return;
      collector.offer({d2, ids_[next]});
    }
  }

 private:
  std::vector<int> ids_;        ///< (N) ids by (place, id)
  std::vector<double> places_;  ///< (N)
};

}  // namespace strongpoint
