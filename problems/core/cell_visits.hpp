#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "methods/core/neighbours.hpp"
#include "methods/core/parallel_errors.hpp"
#include "problems/core/point_cloud.hpp"

namespace strongpoint {

/// Neighbours tried first, by dimension, the node included: settling a cell takes all nodes within
/// twice its radius, some three times as many as it has faces.
inline constexpr int first_neighbours[] = {0, 6, 20, 64};

/// Cells made between two searches: bounds the memory of their neighbour lists.
inline constexpr std::size_t cell_batch_size = 32768;

/// Cells that a worker makes at a time.
inline constexpr int cell_block_size = 128;

/// Some nodes in a row with their neighbours, sorted by distance, the node included.
struct CellBlock {
  std::span<const int> nodes;
  const Stencils& stencils;  ///< of all nodes of the batch
  int first;                 ///< of the block's in the batch
  std::span<char> is_open;   ///< to be set: not 0 where the neighbours do not settle the cell

  int size() const { return static_cast<int>(nodes.size()); }
  std::span<const int> neighbours(int i) const { return stencils[first + i]; }
};

/// Visits the cells of some nodes in parallel with their `neighbours`; marks those left open.
template <class MakeWorker>
void visit_batch(std::span<const int> nodes, const Stencils& neighbours, MakeWorker& make_worker,
                 std::span<char> is_open) {
  ParallelErrors errors;
  const int count = static_cast<int>(nodes.size());
  const int blocks = (count + cell_block_size - 1) / cell_block_size;
#pragma omp parallel
  {
    auto worker = make_worker();
#pragma omp for schedule(dynamic, 1)
    for (int b = 0; b < blocks; ++b) {
      const auto first = static_cast<std::size_t>(b) * cell_block_size;
      const std::size_t size = std::min<std::size_t>(cell_block_size, nodes.size() - first);
      errors.guard(b, [&] {
        worker(CellBlock{nodes.subspan(first, size), neighbours, static_cast<int>(first),
                         is_open.subspan(first, size)});
      });
    }
  }
  errors.rethrow();
}

/// Visits the cell of every node with enough neighbours to settle it. `make_worker()` is called in
/// each thread and gives a worker; `worker(block)` says whether they settled the cells of a
/// `CellBlock`. Nodes left open are visited again with twice as many, at last with all.
template <int Dim, class MakeWorker>
void visit_cells(const PointCloud<Dim>& cloud, const NeighbourSearch<Dim>& search,
                 MakeWorker make_worker) {
  const int count = cloud.size();
  std::vector<int> pending(static_cast<std::size_t>(count));
  std::iota(pending.begin(), pending.end(), 0);
  std::vector<char> is_open;
  int k = std::min(first_neighbours[Dim], count);
  while (!pending.empty()) {
    std::vector<int> open;
    for (std::size_t start = 0; start < pending.size(); start += cell_batch_size) {
      const std::span<const int> nodes = std::span<const int>(pending).subspan(
          start, std::min(cell_batch_size, pending.size() - start));
      is_open.assign(nodes.size(), 0);
      visit_batch(nodes, search.nearest(columns_of<Dim>(cloud.nodes, nodes), k, Ties::cut),
                  make_worker, is_open);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (is_open[i] != 0) open.push_back(nodes[i]);
      }
    }
    pending.swap(open);
    if (k == count) break;
    k = static_cast<int>(std::min<std::int64_t>(2 * static_cast<std::int64_t>(k), count));
  }
}

}  // namespace strongpoint
