#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "methods/core/large_array.hpp"
#include "methods/core/nearest_group.hpp"
#include "methods/core/neighbours_collectors.hpp"
#include "methods/core/neighbours_rows.hpp"
#include "methods/core/parallel_errors.hpp"

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

/// One thread's work on groups of queries for the k nearest nodes.
template <int Dim, class Engine>
class GroupWorker {
 public:
  GroupWorker(const Engine& engine, const Points<Dim>& nodes, const Points<Dim>& queries, int k,
              Ties ties, StencilRows& rows)
      : engine_(engine),
        nodes_(nodes),
        queries_(queries),
        k_(k),
        tie_factor_(ties == Ties::keep ? (1 + tie_tolerance) * (1 + tie_tolerance) : 1.0),
        collector_(k, ties),
        rows_(rows),
        target_(k + 1.5 * std::sqrt(k)),
        room_(std::make_unique<GroupRoom>()) {}

  /// Forgets what earlier groups told of the distances to be expected.
  void start_block(int block) {
    block_ = block;
    square_ = 0;
  }
  /// Treats queries that lie in group g.
  void search(int g, std::span<const int> ids) {
    for (std::size_t first = 0; first < ids.size(); first += group_size) {
      count_ = static_cast<int>(std::min<std::size_t>(group_size, ids.size() - first));
      low_.setConstant(std::numeric_limits<double>::infinity());
      high_ = -low_;
      for (int i = 0; i < count_; ++i) take(i, ids[first + i]);
      search_chunk(g);
    }
  }

 private:
  static constexpr int attempts = 6;

  const Engine& engine_;
  const Points<Dim>& nodes_;
  const Points<Dim>& queries_;
  int k_;
  double tie_factor_;
  NearestCollector collector_;
  StencilRows& rows_;
  int block_ = 0;
  double square_ = 0;  ///< squared distance to gather nodes within, 0: not known
  double target_;      ///< nodes that should be found there, adapted to what the cloud wants
  int count_ = 0;      ///< queries at hand
  int ids_[group_size];
  int* row_[group_size];
  double x_[Dim][group_size];
  Point<Dim> low_, high_;  ///< of the box around them
  double reach_ = 0;       ///< of the list around that box
  std::vector<int> ranges_;
  std::array<std::vector<float>, Dim> list_;
  std::vector<int> list_ids_;
  std::unique_ptr<GroupRoom> room_;
  std::vector<int> stencil_;

  void take(int place, int query) {
    ids_[place] = query;
    row_[place] = rows_.row(query);
    for (int c = 0; c < Dim; ++c) {
      x_[c][place] = queries_(c, query);
      low_[c] = std::min(low_[c], x_[c][place]);
      high_[c] = std::max(high_[c], x_[c][place]);
    }
  }
  void search_chunk(int g) {
    if (square_ == 0) square_ = engine_.expected_square(g, static_cast<int>(target_));
    for (int attempt = 0; attempt < attempts && count_ > 0; ++attempt) {
      if (!search_within(std::sqrt(square_))) break;
      if (sift() == GroupOutcome::few) {
        if (count_ > 0) square_ *= 1.5;
      } else {
        square_ *= 0.6;
      }
    }
    for (int i = 0; i < count_; ++i) search_alone(ids_[i]);
  }
  /// Searches the list around the group; says whether this was possible.
  bool search_within(double radius);
  /// Writes what is settled and keeps the other queries; returns what most of them lack.
  GroupOutcome sift();
  void search_alone(int query) {
    collector_.clear();
    engine_.visit(queries_.col(query), collector_);
    stencil_.clear();
    for (const Candidate& found : collector_.finish()) stencil_.push_back(found.node);
    rows_.write(block_, query, stencil_);
  }
};

template <int Dim, class Engine>
bool GroupWorker<Dim, Engine>::search_within(double radius) {
  reach_ = 1.15 * radius;
  const double reach = reach_;
  NearestGroup task{};
  double widest = 0;
  for (int c = 0; c < Dim; ++c) {
    task.middle[c] = low_[c] + (high_[c] - low_[c]) / 2;
    task.half[c] = std::max(high_[c] - task.middle[c], task.middle[c] - low_[c]);
    widest = std::max(widest, task.half[c]);
  }
  // Written so that NaN fails it too. Squares must neither overflow nor vanish.
  if (!(reach > 1e-140 && reach < 1e140 && widest < 100 * reach)) return false;
  task.range_count = engine_.list_ranges(low_, high_, reach, ranges_);
  std::size_t length = 0;
  for (int r = 0; r < task.range_count; ++r) length += ranges_[2 * r + 1] - ranges_[2 * r];
  if (list_ids_.size() < length + 32) {
    for (std::vector<float>& list : list_) list.resize(2 * length + 32);
    list_ids_.resize(2 * length + 32);
  }
  task.dim = Dim;
  task.k = k_;
  for (int c = 0; c < Dim; ++c) {
    task.nodes[c] = engine_.sorted().coordinates[c].data();
    task.queries[c] = x_[c];
    task.list[c] = list_[c].data();
  }
  task.ids = engine_.sorted().ids.data();
  task.ranges = ranges_.data();
  task.query_count = count_;
  task.rows = row_;
  task.reach = reach;
  task.limit = 1 / (1.15F * 1.15F);
  task.target = static_cast<float>(target_);
  task.gain = 1.2F / Dim;
  task.list_ids = list_ids_.data();
  task.room = room_.get();
  nearest_of_group(task);
  ExactOrder rest{};
  rest.dim = Dim;
  rest.k = k_;
  rest.nodes = nodes_.data();
  for (int c = 0; c < Dim; ++c) rest.queries[c] = x_[c];
  rest.query_count = count_;
  rest.tie_factor = tie_factor_;
  rest.room = room_.get();
  order_exactly(rest);
  return true;
}

template <int Dim, class Engine>
GroupOutcome GroupWorker<Dim, Engine>::sift() {
  int kept = 0;
  int few = 0;
  const int before = count_;
  for (int i = 0; i < count_; ++i) {
    const GroupOutcome outcome = room_->outcome[i];
    if (outcome == GroupOutcome::ambiguous) {
      rows_.write(block_, ids_[i],
                  {room_->sorted[i], static_cast<std::size_t>(room_->candidates[i])});
    }
    if (outcome == GroupOutcome::found || outcome == GroupOutcome::ambiguous) continue;
    if (outcome == GroupOutcome::few) ++few;
    ids_[kept] = ids_[i];
    row_[kept] = row_[i];
    for (int c = 0; c < Dim; ++c) x_[c][kept] = x_[c][i];
    ++kept;
  }
  square_ = room_->limit * reach_ * reach_;
  // Settles where about one query in thirty has to be gathered again.
  const double wish = target_ + 0.3 * (room_->retries - 0.03 * before);
  target_ = std::clamp(wish, k_ + 1.0, 2.0 * k_ + 20.0);
  count_ = kept;
  return kept == 0 || 2 * few >= kept ? GroupOutcome::few : GroupOutcome::many;
}

/// The k nearest nodes of many queries, group by group in parallel.
template <int Dim, class Engine>
Stencils nearest_in_groups(const Engine& engine, const Points<Dim>& nodes,
                           const Points<Dim>& queries, int k, Ties ties) {
  constexpr int groups_per_block = 64;
  const int blocks = (engine.groups() + groups_per_block - 1) / groups_per_block;
  const QueryOrder<Dim> order(engine, nodes, queries);
  StencilRows rows(static_cast<int>(queries.cols()), k, blocks);
  ParallelErrors errors;
#pragma omp parallel
  {
    GroupWorker<Dim, Engine> worker(engine, nodes, queries, k, ties, rows);
    std::vector<int> ids;
#pragma omp for schedule(dynamic)
    for (int b = 0; b < blocks; ++b) {
      errors.guard(b, [&] {
        worker.start_block(b);
        const int end = std::min(engine.groups(), (b + 1) * groups_per_block);
        for (int g = b * groups_per_block; g < end; ++g) {
          worker.search(g, order.of_group(engine, g, ids));
        }
      });
    }
  }
  errors.rethrow();
  return rows.finish();
}

}  // namespace strongpoint
