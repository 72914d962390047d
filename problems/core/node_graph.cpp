#include "problems/core/node_graph.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace strongpoint {
namespace {

/// Lists of nodes in compressed rows.
struct Lists {
  std::vector<int> offsets{0}, ids;
};

/// Whether the row after that whose offset is given has the same columns.
bool is_repeated(const std::int64_t* offset, const std::int64_t* columns) {
  return std::equal(columns + offset[0], columns + offset[1], columns + offset[1],
                    columns + offset[2]);
}

/// The other nodes in the rows of each node, once each.
Lists couplings(const Eigen::Map<const RowMatrix>& matrix, int fields) {
  const auto nodes = static_cast<int>(matrix.rows() / fields);
  const std::int64_t* const offsets = matrix.outerIndexPtr();
  const std::int64_t* const columns = matrix.innerIndexPtr();
  Lists lists;
  lists.ids.reserve(static_cast<std::size_t>(offsets[matrix.rows()] / fields));
  std::vector<int> last(nodes, -1);
  for (int node = 0; node < nodes; ++node) {
    last[node] = node;
    const std::int64_t first = std::int64_t{node} * fields;
    for (std::int64_t row = first; row < first + fields; ++row) {
      const std::span<const std::int64_t> entries(columns + offsets[row],
                                                  columns + offsets[row + 1]);
      if (row > first && is_repeated(offsets + row - 1, columns)) continue;
      std::int64_t end = 0;  // of the columns of the last node
      for (const std::int64_t column : entries) {
        if (column < end && column >= end - fields) continue;
        const auto other = static_cast<int>(column / fields);
        end = (std::int64_t{other} + 1) * fields;
        if (last[other] == node) continue;
        last[other] = node;
        lists.ids.push_back(other);
      }
    }
    lists.offsets.push_back(static_cast<int>(lists.ids.size()));
  }
  return lists;
}

/// The lists that each node occurs in, ascending.
Lists turned(const Lists& lists) {
  const auto nodes = static_cast<int>(lists.offsets.size()) - 1;
  Lists result;
  result.offsets.assign(nodes + 1, 0);
  for (const int id : lists.ids) ++result.offsets[id + 1];
  for (int node = 0; node < nodes; ++node) result.offsets[node + 1] += result.offsets[node];
  result.ids.resize(lists.ids.size());
  std::vector<int> next(result.offsets.begin(), result.offsets.end() - 1);
  for (int node = 0; node < nodes; ++node) {
    for (int i = lists.offsets[node]; i < lists.offsets[node + 1]; ++i) {
      result.ids[next[lists.ids[i]]++] = node;
    }
  }
  return result;
}

}  // namespace

NodeGraph node_graph(const Eigen::Map<const RowMatrix>& matrix, int fields) {
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  if (2 * matrix.nonZeros() / fields > most) return {};
  const Lists rows = couplings(matrix, fields);
  const Lists columns = turned(rows);
  const auto nodes = static_cast<int>(rows.offsets.size()) - 1;
  Lists both;
  both.ids.reserve(2 * rows.ids.size());
  std::vector<int> last(nodes, -1);
  for (int node = 0; node < nodes; ++node) {
    for (const Lists* lists : {&rows, &columns}) {
      for (int i = lists->offsets[node]; i < lists->offsets[node + 1]; ++i) {
        const int other = lists->ids[i];
        if (last[other] == node) continue;
        last[other] = node;
        both.ids.push_back(other);
      }
    }
    both.offsets.push_back(static_cast<int>(both.ids.size()));
  }
  Lists sorted = turned(both);  // the same graph, as it is symmetric
  return {std::move(sorted.offsets), std::move(sorted.ids)};
}

}  // namespace strongpoint
