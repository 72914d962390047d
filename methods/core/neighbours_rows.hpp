#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "methods/core/large_array.hpp"
#include "methods/core/stencils.hpp"

namespace strongpoint {

/// Stencils while they are made: k nodes a query, written where they stay, and what ties with the
/// last of them in lists aside, one a block of queries.
class StencilRows {
 public:
  StencilRows(int queries, int k, int blocks)
      : queries_(queries), k_(k), nodes_(static_cast<std::size_t>(queries) * k), extras_(blocks) {}

  /// Where the first k nodes of a query go.
  int* row(int query) { return nodes_.data() + static_cast<std::size_t>(query) * k_; }
  /// Writes a whole stencil of at least k nodes; called by one thread per block.
  void write(int block, int query, std::span<const int> stencil) {
    std::copy_n(stencil.begin(), k_, row(query));
    if (stencil.size() == static_cast<std::size_t>(k_)) return;
    Extras& extras = extras_[block];
    extras.queries.push_back(query);
    extras.sizes.push_back(static_cast<int>(stencil.size()) - k_);
    extras.nodes.insert(extras.nodes.end(), stencil.begin() + k_, stencil.end());
  }
  /// The stencils; the rows are used up.
  Stencils finish() {
    Stencils result;
    result.offsets.resize(static_cast<std::size_t>(queries_) + 1);
    bool is_even = true;
    for (const Extras& extras : extras_) is_even = is_even && extras.queries.empty();
    if (is_even) {
      for (int q = 0; q < queries_; ++q) result.offsets[q + 1] = result.offsets[q] + k_;
      result.nodes = std::move(nodes_);
      return result;
    }
    for (const Extras& extras : extras_) {
      for (std::size_t i = 0; i < extras.queries.size(); ++i) {
        result.offsets[extras.queries[i] + 1] = extras.sizes[i];
      }
    }
    for (int q = 0; q < queries_; ++q) result.offsets[q + 1] += result.offsets[q] + k_;
    merge_into(result);
    return result;
  }

 private:
  /// What the queries of a block have beyond k.
  struct Extras {
    std::vector<int> queries, sizes, nodes;
  };

  int queries_, k_;
  LargeArray<int> nodes_;       ///< (queries k)
  std::vector<Extras> extras_;  ///< (blocks)

  void merge_into(Stencils& result) {
    result.nodes.resize(static_cast<std::size_t>(result.offsets.back()));
#pragma omp parallel for schedule(static)
    for (int q = 0; q < queries_; ++q) {
      std::copy_n(row(q), k_, result.nodes.begin() + result.offsets[q]);
    }
#pragma omp parallel for schedule(static)
    for (int b = 0; b < static_cast<int>(extras_.size()); ++b) {
      auto from = extras_[b].nodes.begin();
      for (std::size_t i = 0; i < extras_[b].queries.size(); ++i) {
        std::copy_n(from, extras_[b].sizes[i],
                    result.nodes.begin() + result.offsets[extras_[b].queries[i]] + k_);
        from += extras_[b].sizes[i];
      }
    }
  }
};

}  // namespace strongpoint
