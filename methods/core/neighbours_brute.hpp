#pragma once

#include "methods/core/neighbours_collectors.hpp"

namespace strongpoint {

/// Looks at every node: the oracle of the tests, and fast enough for a few hundred nodes.
template <int Dim>
class BruteEngine {
 public:
  explicit BruteEngine(const Points<Dim>& nodes) : nodes_(nodes) {}

  /// Offers all nodes within the collector's bound.
  void visit(const Point<Dim>& query, CandidateCollector auto& collector) const {
    for (int node = 0; node < static_cast<int>(nodes_.cols()); ++node) {
      const double d2 = squared_distance<Dim>(query, nodes_.col(node));
      if (d2 <= collector.bound()) collector.offer({d2, node});
    }
  }

 private:
  const Points<Dim>& nodes_;
};

}  // namespace strongpoint
