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

/// Neighbours tried first and second, by dimension, the node included: settling a cell takes all
/// nodes within twice its radius, some three times as many as it has faces. What is left open then
/// is searched by its own radius, which costs several times as much.
inline constexpr int first_neighbours[][2] = {{0, 0}, {6, 12}, {24, 48}, {64, 96}};

/// Cells made between two searches: bounds the memory of their neighbour lists.
inline constexpr std::size_t cell_batch_size = 32768;

/// Cells that a worker makes at a time.
inline constexpr int cell_block_size = 128;

/// A search reaches at least this much farther than the one before.
inline constexpr double least_growth = 1.3;

/// More than the round-off of a radius.
inline constexpr double radius_slack = 1 + 1e-9;

/// Some nodes in a row with their neighbours, sorted by distance, the node included.
struct CellBlock {
  std::span<const int> nodes;
  const Stencils& stencils;         ///< of all nodes of the batch
  int first;                        ///< of the block's in the batch
  std::span<const double> reaches;  ///< distance up to which all nodes are among the neighbours
  std::span<double> wanted;  ///< to be set: 0 where the neighbours settle the cell, else the reach
                             ///< that would settle what is left of it

  int size() const { return static_cast<int>(nodes.size()); }
  std::span<const int> neighbours(int i) const { return stencils[first + i]; }
};

/// Nodes whose cells are to be made from their neighbours up to given distances.
struct CellBatch {
  std::span<const int> nodes;
  const Stencils& neighbours;
  std::span<const double> reaches;
  std::span<double> wanted;
};

/// Visits the cells of some nodes in parallel.
template <class MakeWorker>
void visit_batch(const CellBatch& batch, MakeWorker& make_worker) {
  ParallelErrors errors;
  const int count = static_cast<int>(batch.nodes.size());
  const int blocks = (count + cell_block_size - 1) / cell_block_size;
#pragma omp parallel
  {
    auto worker = make_worker();
#pragma omp for schedule(dynamic, 1)
    for (int b = 0; b < blocks; ++b) {
      const auto first = static_cast<std::size_t>(b) * cell_block_size;
      const std::size_t size = std::min<std::size_t>(cell_block_size, batch.nodes.size() - first);
      errors.guard(b, [&] {
        worker(CellBlock{batch.nodes.subspan(first, size), batch.neighbours,
                         static_cast<int>(first), batch.reaches.subspan(first, size),
                         batch.wanted.subspan(first, size)});
      });
    }
  }
  errors.rethrow();
}

/// Cells that are not settled yet.
struct OpenCells {
  std::vector<int> nodes;
  std::vector<double> reaches;  ///< to search up to
};

/// Visits some cells; adds to `open` those that want farther neighbours, unless all are known.
template <class MakeWorker>
void visit_cells_with(const CellBatch& batch, int all, MakeWorker& make_worker, OpenCells& open) {
  visit_batch(batch, make_worker);
  for (std::size_t i = 0; i < batch.nodes.size(); ++i) {
    const int known = static_cast<int>(batch.neighbours[static_cast<int>(i)].size());
    if (batch.wanted[i] == 0 || known == all) continue;
    open.nodes.push_back(batch.nodes[i]);
    open.reaches.push_back(
        std::max(radius_slack * batch.wanted[i], least_growth * batch.reaches[i]));
  }
}

/// Visits the cell of every node with enough neighbours to settle it. `make_worker()` is called in
/// each thread and gives a worker; `worker(block)` says whether they settled the cells of a
/// `CellBlock`. Nodes left open are visited again with all nodes that may cut what is left of their
/// cells.
template <int Dim, class MakeWorker>
void visit_cells(const PointCloud<Dim>& cloud, const NeighbourSearch<Dim>& search,
                 MakeWorker make_worker) {
  const int count = cloud.size();
  OpenCells pending;
  pending.nodes.resize(static_cast<std::size_t>(count));
  std::iota(pending.nodes.begin(), pending.nodes.end(), 0);
  std::vector<double> reaches, wanted;
  for (int round = 0; !pending.nodes.empty(); ++round) {
    OpenCells open;
    for (std::size_t start = 0; start < pending.nodes.size(); start += cell_batch_size) {
      const std::size_t size = std::min(cell_batch_size, pending.nodes.size() - start);
      const std::span<const int> nodes = std::span<const int>(pending.nodes).subspan(start, size);
      const Points<Dim> queries = columns_of<Dim>(cloud.nodes, nodes);
      wanted.assign(size, 0);
      Stencils neighbours;
      if (round < 2) {
        const int k = std::min(first_neighbours[Dim][round], count);
        neighbours = search.nearest(queries, k, Ties::cut);
        reaches.resize(size);
        for (std::size_t i = 0; i < size; ++i) {
          const int last = neighbours[static_cast<int>(i)].back();
          reaches[i] = (cloud.nodes.col(last) - cloud.nodes.col(nodes[i])).norm();
        }
      } else {
        const auto from = pending.reaches.begin() + static_cast<std::ptrdiff_t>(start);
        reaches.assign(from, from + static_cast<std::ptrdiff_t>(size));
        neighbours = search.within(queries, reaches);
      }
      visit_cells_with({nodes, neighbours, reaches, wanted}, count, make_worker, open);
    }
    std::swap(pending, open);
  }
}

}  // namespace strongpoint
