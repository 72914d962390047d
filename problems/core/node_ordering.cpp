#include "problems/core/node_ordering.hpp"

#include <algorithm>
#include <limits>
#include <metis.h>

namespace strongpoint {
namespace {

/// Which nodes are coupled, both ways and without themselves, in compressed rows.
struct Graph {
  std::vector<idx_t> offsets, neighbours;
};

/// Calls `visit(node, other)` for each coupling of a node's rows, once.
template <class Visit>
void each_coupling(const Eigen::Map<const RowMatrix>& matrix, int fields, const Visit& visit) {
  const auto nodes = static_cast<std::int64_t>(matrix.rows() / fields);
  std::vector<std::int64_t> last(nodes, -1);
  const std::int64_t* offsets = matrix.outerIndexPtr();
  const std::int64_t* columns = matrix.innerIndexPtr();
  for (std::int64_t node = 0; node < nodes; ++node) {
    last[node] = node;
    for (std::int64_t i = offsets[node * fields]; i < offsets[(node + 1) * fields]; ++i) {
      const std::int64_t other = columns[i] / fields;
      if (last[other] == node) continue;
      last[other] = node;
      visit(node, other);
    }
  }
}

/// The graph; empty when it is too large for the library's numbers.
Graph graph_of(const Eigen::Map<const RowMatrix>& matrix, int fields) {
  const auto nodes = static_cast<std::int64_t>(matrix.rows() / fields);
  std::vector<std::int64_t> ends(nodes + 1, 0);
  each_coupling(matrix, fields, [&](std::int64_t a, std::int64_t b) {
    ++ends[a + 1];
    ++ends[b + 1];
  });
  for (std::int64_t node = 0; node < nodes; ++node) ends[node + 1] += ends[node];
  if (ends[nodes] > std::numeric_limits<idx_t>::max()) return {};
  std::vector<idx_t> twice(ends[nodes]);
  std::vector<std::int64_t> next(ends.begin(), ends.end() - 1);
  each_coupling(matrix, fields, [&](std::int64_t a, std::int64_t b) {
    twice[next[a]++] = static_cast<idx_t>(b);
    twice[next[b]++] = static_cast<idx_t>(a);
  });
  Graph graph;
  graph.offsets.reserve(nodes + 1);
  graph.offsets.push_back(0);
  graph.neighbours.reserve(twice.size());
  for (std::int64_t node = 0; node < nodes; ++node) {
    const auto begin = twice.begin() + ends[node];
    std::sort(begin, twice.begin() + ends[node + 1]);
    const auto end = std::unique(begin, twice.begin() + ends[node + 1]);
    graph.neighbours.insert(graph.neighbours.end(), begin, end);
    graph.offsets.push_back(static_cast<idx_t>(graph.neighbours.size()));
  }
  return graph;
}

}  // namespace

std::vector<std::int64_t> node_ordering(const Eigen::Map<const RowMatrix>& matrix, int fields) {
  if (matrix.rows() == 0 || matrix.rows() % fields != 0) return {};
  Graph graph = graph_of(matrix, fields);
  if (graph.offsets.empty()) return {};
  auto nodes = static_cast<idx_t>(matrix.rows() / fields);
  std::vector<idx_t> order(nodes), places(nodes);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  const int status = METIS_NodeND(&nodes, graph.offsets.data(), graph.neighbours.data(), nullptr,
                                  options, order.data(), places.data());
  if (status != METIS_OK) return {};
  std::vector<std::int64_t> unknowns;
  unknowns.reserve(matrix.rows());
  for (const idx_t node : order) {
    for (int field = 0; field < fields; ++field) {
      unknowns.push_back(static_cast<std::int64_t>(node) * fields + field);
    }
  }
  return unknowns;
}

}  // namespace strongpoint
