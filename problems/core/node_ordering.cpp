#include "problems/core/node_ordering.hpp"

#include <metis.h>
#include <type_traits>

#include "problems/core/node_graph.hpp"

namespace strongpoint {

std::vector<std::int64_t> node_ordering(const Eigen::Map<const RowMatrix>& matrix, int fields) {
  if (matrix.rows() == 0 || matrix.rows() % fields != 0) return {};
  NodeGraph graph = node_graph(matrix, fields);
  if (graph.offsets.empty()) return {};
  static_assert(std::is_same_v<idx_t, int>, "the graph is handed over as it is");
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
