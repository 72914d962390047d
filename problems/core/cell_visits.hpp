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
inline constexpr int first_neighbours[] = {0, 6, 20, 48};

/// Cells made between two searches: bounds the memory of their neighbour lists.
inline constexpr std::size_t cell_batch_size = 32768;

/// Visits the cells of some nodes in parallel with their `neighbours`; marks those left open.
template <class MakeWorker>
void visit_batch(std::span<const int> nodes, const Stencils& neighbours, MakeWorker& make_worker,
                 std::vector<char>& is_open) {
  ParallelErrors errors;
#pragma omp parallel
  {
    auto worker = make_worker();
#pragma omp for schedule(dynamic, 64)
    for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
      errors.guard(i, [&] { is_open[i] = worker(nodes[i], neighbours[i]) ? 0 : 1; });
    }
  }
  errors.rethrow();
}

/// Visits the cell of every node with enough neighbours to settle it. `make_worker()` is called in
/// each thread and gives a worker; `worker(node, neighbours)`, neighbours sorted by distance and
/// the node included, says whether they settled the cell. Nodes left open are visited again with
/// twice as many, at last with all.
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
