#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "methods/core/large_array.hpp"
#include "methods/core/neighbours_collectors.hpp"

namespace strongpoint {

/// The nodes of an engine in its own order, coordinates as a structure of arrays, so that what lies
/// together is stored together.
template <int Dim>
struct SortedNodes {
  static constexpr int padding = 8;                 ///< entries behind the last node
  std::array<LargeArray<double>, Dim> coordinates;  ///< (N + padding) each
  std::vector<int> ids;                             ///< (N + padding)

  int size() const { return ids.empty() ? 0 : static_cast<int>(ids.size()) - padding; }
  /// Takes the nodes in the order of `order`.
  void assign(const Points<Dim>& nodes, std::vector<int> order) {
    ids = std::move(order);
    const std::size_t count = ids.size();
    for (int c = 0; c < Dim; ++c) {
      coordinates[c].resize(count + padding);
      for (std::size_t i = 0; i < count; ++i) coordinates[c][i] = nodes(c, ids[i]);
      for (std::size_t i = count; i < count + padding; ++i) coordinates[c][i] = 0;
    }
    ids.resize(count + padding);
  }
};

/// Squared radius of a ball that holds as many nodes as `cubes` cubes with an edge in a number of
/// directions.
inline double square_of_ball(double cubes, double edge, int directions) {
  constexpr double unit_ball[] = {1, 2, 3.14159265358979, 4.18879020478639};
  if (directions == 0) return 0;
  const double radius = edge * std::pow(cubes / unit_ball[directions], 1.0 / directions);
  return radius * radius;
}

/// An engine whose nodes come in groups that lie together, so that one list of nodes serves all
/// queries of a group.
template <class E, int Dim>
concept GroupEngine = Dim >
1 && requires(const E& engine, const Point<Dim>& x, std::vector<int>& ranges) {
  { engine.sorted() } -> std::convertible_to<const SortedNodes<Dim>&>;
  { engine.groups() } -> std::convertible_to<int>;
  { engine.group(0) } -> std::convertible_to<std::pair<int, int>>;
  { engine.group_of(x) } -> std::convertible_to<int>;
  { engine.expected_square(0, 1) } -> std::convertible_to<double>;
  { engine.list_ranges(x, x, 1.0, ranges) } -> std::convertible_to<int>;
};

/// Which queries lie in which group of an engine's nodes. Queries that are nodes, all or some in
/// ascending order, are told by their coordinates; others are looked up one by one.
template <int Dim>
class QueryOrder {
 public:
  template <class Engine>
  QueryOrder(const Engine& engine, const Points<Dim>& nodes, const Points<Dim>& queries) {
    if (match_nodes(nodes, queries)) return;
    const int count = static_cast<int>(queries.cols());
    std::vector<int> group(static_cast<std::size_t>(count));
#pragma omp parallel for schedule(static)
    for (int q = 0; q < count; ++q) group[q] = engine.group_of(queries.col(q));
    starts_.assign(static_cast<std::size_t>(engine.groups()) + 1, 0);
    for (int g : group) ++starts_[g + 1];
    for (int g = 0; g < engine.groups(); ++g) starts_[g + 1] += starts_[g];
    std::vector<int> next(starts_.begin(), starts_.end() - 1);
    queries_.resize(static_cast<std::size_t>(count));
    for (int q = 0; q < count; ++q) queries_[next[group[q]]++] = q;
  }

  /// The queries of group g; `room` is used where they have to be listed.
  template <class Engine>
  std::span<const int> of_group(const Engine& engine, int g, std::vector<int>& room) const {
    if (!starts_.empty()) return {queries_.data() + starts_[g], queries_.data() + starts_[g + 1]};
    const auto [begin, end] = engine.group(g);
    const std::span<const int> nodes{engine.sorted().ids.data() + begin,
                                     engine.sorted().ids.data() + end};
    if (query_of_.empty()) return nodes;
    room.clear();
    for (int node : nodes) {
      if (query_of_[node] >= 0) room.push_back(query_of_[node]);
    }
    return room;
  }

 private:
  std::vector<int> query_of_;  ///< (N) the query at each node or -1, empty when query = node
  std::vector<int> starts_;    ///< (groups + 1) into `queries_`, where queries are no nodes
  std::vector<int> queries_;

  bool match_nodes(const Points<Dim>& nodes, const Points<Dim>& queries) {
    const int count = static_cast<int>(queries.cols());
    const int limit = static_cast<int>(nodes.cols());
    if (count > limit) return false;
    if (count == limit && (nodes.data() == queries.data() || nodes == queries)) return true;
    std::vector<int> query_of(static_cast<std::size_t>(limit), -1);
    int node = 0;
    for (int q = 0; q < count; ++q, ++node) {
      while (node < limit && nodes.col(node) != queries.col(q)) ++node;
      if (node == limit) return false;
      query_of[node] = q;
    }
    query_of_ = std::move(query_of);
    return true;
  }
};

}  // namespace strongpoint
