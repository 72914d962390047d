#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "methods/core/candidate.hpp"
#include "methods/core/method.hpp"
#include "methods/core/neighbours.hpp"

namespace strongpoint {

/// A way to choose the nodes of each stencil.
template <int Dim>
class StencilRule {
 public:
  StencilRule() = default;
  StencilRule(const StencilRule&) = delete;
  StencilRule& operator=(const StencilRule&) = delete;
  virtual ~StencilRule() = default;

  /// What has to be prepared beside the nodes.
  virtual Needs needs() const { return {}; }
  /// One stencil for each anchor listed, sorted by (distance, node id). Throws SkipCase when the
  /// sites cannot serve the rule (an index block on a cloud without structure).
  virtual Stencils select(const Sites<Dim>& sites, std::span<const int> anchors,
                          const Method<Dim>& method, const NeighbourSearch<Dim>& search) const = 0;
};

/// Stencils of all anchors by a rule; empty where none is wanted.
template <int Dim>
Stencils select_stencils(const StencilRule<Dim>& rule, const Sites<Dim>& sites,
                         const Method<Dim>& method, const NeighbourSearch<Dim>& search) {
  const std::vector<int> anchors = sites.wanted_anchors();
  Stencils chosen = rule.select(sites, anchors, method, search);
  if (anchors.size() == sites.wanted.size()) return chosen;
  // The nodes are in place: only the offsets of empty stencils are missing.
  Stencils all;
  all.offsets.resize(static_cast<std::size_t>(sites.anchor_count()) + 1);
  int next = 0;
  for (int a = 0; a < sites.anchor_count(); ++a) {
    if (sites.wanted[a] != 0) ++next;
    all.offsets[a + 1] = chosen.offsets[next];
  }
  all.nodes = std::move(chosen.nodes);
  return all;
}

/// The k nearest nodes of the anchors listed; positions are copied only when these are not all.
template <int Dim>
Stencils nearest_to_anchors(const Sites<Dim>& sites, std::span<const int> anchors, int k, Ties ties,
                            const NeighbourSearch<Dim>& search) {
  bool are_all = static_cast<int>(anchors.size()) == sites.anchor_count();
  for (std::size_t i = 0; are_all && i < anchors.size(); ++i) {
    are_all = anchors[i] == static_cast<int>(i);
  }
  if (are_all) return search.nearest(sites.anchors, k, ties);
  return search.nearest(columns_of<Dim>(sites.anchors, anchors), k, ties);
}

/// Squared distance of a node from an anchor, by the same sum as the neighbour search.
template <int Dim>
double squared_distance(const Sites<Dim>& sites, int anchor, int node) {
  double sum = 0;
  for (int c = 0; c < Dim; ++c) {
    const double difference = sites.anchors(c, anchor) - sites.nodes(c, node);
    sum += difference * difference;
  }
  return sum;
}

/// Sorts nodes by (distance from an anchor, node id).
template <int Dim>
void sort_stencil(const Sites<Dim>& sites, int anchor, std::span<int> nodes) {
  std::vector<Candidate> ranked;
  ranked.reserve(nodes.size());
  for (int node : nodes) ranked.push_back({squared_distance(sites, anchor, node), node});
  std::sort(ranked.begin(), ranked.end());
  for (std::size_t j = 0; j < nodes.size(); ++j) nodes[j] = ranked[j].node;
}

}  // namespace strongpoint
