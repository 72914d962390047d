#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "methods/core/nearest_group.hpp"
#include "methods/core/neighbours_groups.hpp"
#include "methods/core/neighbours_rows.hpp"
#include "methods/core/parallel_errors.hpp"

namespace strongpoint {

/// Queries that lie together, and room for their search.
template <int Dim, class Engine>
class QueryGroup {
 public:
  QueryGroup(const Engine& engine, const Points<Dim>& nodes, const Points<Dim>& queries)
      : engine_(engine), nodes_(nodes), queries_(queries), room_(std::make_unique<GroupRoom>()) {}

  int size() const { return count_; }
  int query(int place) const { return ids_[place]; }
  const GroupRoom& room() const { return *room_; }
  double reach() const { return reach_; }
  void clear() {
    count_ = 0;
    low_.setConstant(std::numeric_limits<double>::infinity());
    high_ = -low_;
  }
  /// Adds a query, whose row is at `row`; `group_size` at most.
  void take(int query, int* row) {
    ids_[count_] = query;
    row_[count_] = row;
    for (int c = 0; c < Dim; ++c) {
      const double x = queries_(c, query);
      x_[c][count_] = x;
      low_[c] = std::min(low_[c], x);
      high_[c] = std::max(high_[c], x);
    }
    ++count_;
  }
  /// Takes the task of searching a list of all nodes within `reach` of the queries; says whether
  /// this is possible.
  bool prepare(double reach, NearestGroup& task);
  /// Puts what is ambiguous into exact order.
  void order(int k, double tie_factor, const double* bounds) {
    ExactOrder task{};
    task.dim = Dim;
    task.k = k;
    task.nodes = nodes_.data();
    for (int c = 0; c < Dim; ++c) task.queries[c] = x_[c];
    task.query_count = count_;
    task.tie_factor = tie_factor;
    task.bounds = bounds;
    task.room = room_.get();
    order_exactly(task);
  }
  /// Writes what is settled and keeps the other queries.
  void settle(StencilRows& rows, int block) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      const GroupOutcome outcome = room_->outcome[i];
      if (outcome == GroupOutcome::ambiguous) {
        rows.write(block, ids_[i],
                   {room_->sorted[i], static_cast<std::size_t>(room_->candidates[i])});
      }
      if (outcome == GroupOutcome::found || outcome == GroupOutcome::ambiguous) continue;
      room_->outcome[kept] = outcome;
      ids_[kept] = ids_[i];
      row_[kept] = row_[i];
      for (int c = 0; c < Dim; ++c) x_[c][kept] = x_[c][i];
      ++kept;
    }
    count_ = kept;
  }
  /// Searches the whole cloud for one query.
  template <class Collector>
  void search_alone(int query, Collector& collector, StencilRows& rows, int block) {
    engine_.visit(queries_.col(query), collector);
    stencil_.clear();
    for (const Candidate& found : collector.finish()) stencil_.push_back(found.node);
    rows.write(block, query, stencil_);
  }

 private:
  const Engine& engine_;
  const Points<Dim>& nodes_;
  const Points<Dim>& queries_;
  int count_ = 0;
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
};

template <int Dim, class Engine>
bool QueryGroup<Dim, Engine>::prepare(double reach, NearestGroup& task) {
  reach_ = reach;
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
  task.list_ids = list_ids_.data();
  task.room = room_.get();
  return true;
}

/// One thread's search of groups for the k nearest nodes.
template <int Dim, class Engine>
class NearestWorker {
 public:
  NearestWorker(const Engine& engine, const Points<Dim>& nodes, const Points<Dim>& queries, int k,
                Ties ties, StencilRows& rows)
      : engine_(engine),
        group_(engine, nodes, queries),
        k_(k),
        tie_factor_(ties == Ties::keep ? (1 + tie_tolerance) * (1 + tie_tolerance) : 1.0),
        collector_(k, ties),
        rows_(rows),
        target_(k + 1.5 * std::sqrt(k)) {}

  /// Searches for queries that lie in group g of the nodes.
  void search(int block, int g, std::span<const int> ids) {
    for (std::size_t first = 0; first < ids.size(); first += group_size) {
      group_.clear();
      for (int query : ids.subspan(first, std::min<std::size_t>(group_size, ids.size() - first))) {
        group_.take(query, rows_.row(query));
      }
      search_group(block, g);
    }
  }

 private:
  static constexpr int attempts = 6;
  static constexpr double spare = 1.15;  ///< reach of a list over the distance hoped for

  const Engine& engine_;
  QueryGroup<Dim, Engine> group_;
  int k_;
  double tie_factor_;
  NearestCollector collector_;
  StencilRows& rows_;
  double square_ = 0;  ///< squared distance to gather nodes within, 0: not known
  double target_;      ///< nodes that should be found there, adapted to what the cloud wants

  void search_group(int block, int g) {
    if (!(square_ > 0)) square_ = engine_.expected_square(g, static_cast<int>(target_));
    for (int attempt = 0; attempt < attempts && group_.size() > 0; ++attempt) {
      NearestGroup task{};
      if (!group_.prepare(spare * std::sqrt(square_), task)) break;
      task.k = k_;
      task.limit = static_cast<float>(1 / (spare * spare));
      task.target = static_cast<float>(target_);
      task.gain = 1.2F / Dim;
      nearest_of_group(task);
      group_.order(k_, tie_factor_, nullptr);
      adapt();
      group_.settle(rows_, block);
      if (group_.size() == 0) return;
      square_ *= group_.room().outcome[0] == GroupOutcome::few ? 1.5 : 0.6;
    }
    // Groups that follow must not inherit what did not serve this one.
    if (group_.size() > 0) square_ = 0;
    for (int i = 0; i < group_.size(); ++i) {
      collector_.clear();
      group_.search_alone(group_.query(i), collector_, rows_, block);
    }
  }
  /// Follows what the queries found: about one in thirty should have to gather again.
  void adapt() {
    square_ = group_.room().limit * group_.reach() * group_.reach();
    const double wish = target_ + 0.3 * (group_.room().retries - 0.03 * group_.size());
    target_ = std::clamp(wish, k_ + 1.0, 2.0 * k_ + 20.0);
  }
};

/// One thread's search of groups for all nodes within radii.
template <int Dim, class Engine>
class WithinWorker {
 public:
  WithinWorker(const Engine& engine, const Points<Dim>& nodes, const Points<Dim>& queries,
               std::span<const double> radii, StencilRows& rows)
      : group_(engine, nodes, queries), radii_(radii), rows_(rows) {}

  /// Searches for queries that lie in group g of the nodes.
  void search(int block, int /*g*/, std::span<const int> ids) {
    for (std::size_t first = 0; first < ids.size(); first += group_size) {
      group_.clear();
      double reach = 0;
      for (int query : ids.subspan(first, std::min<std::size_t>(group_size, ids.size() - first))) {
        bounds_[group_.size()] = radii_[query] < 0 ? -1 : radii_[query] * radii_[query];
        reach = std::max(reach, radii_[query]);
        group_.take(query, nullptr);
      }
      NearestGroup task{};
      if (group_.prepare(reach, task)) {
        task.bounds = bounds_;
        nearest_of_group(task);
        group_.order(0, 1, bounds_);
        group_.settle(rows_, block);
      }
      for (int i = 0; i < group_.size(); ++i) {
        collector_.clear(radii_[group_.query(i)]);
        group_.search_alone(group_.query(i), collector_, rows_, block);
      }
    }
  }

 private:
  QueryGroup<Dim, Engine> group_;
  std::span<const double> radii_;
  StencilRows& rows_;
  RadiusCollector collector_;
  double bounds_[group_size];
};

/// Treats all queries, group by group in parallel. `make_worker(rows)` is called once a thread;
/// at least `k` nodes are found for each query.
template <int Dim, class Engine, class MakeWorker>
Stencils search_in_groups(const Engine& engine, const Points<Dim>& nodes,
                          const Points<Dim>& queries, int k, const MakeWorker& make_worker) {
  constexpr int groups_per_block = 64;
  const int blocks = (engine.groups() + groups_per_block - 1) / groups_per_block;
  const QueryOrder<Dim> order(engine, nodes, queries);
  StencilRows rows(static_cast<int>(queries.cols()), k, blocks);
  ParallelErrors errors;
#pragma omp parallel
  {
    auto worker = make_worker(rows);
    std::vector<int> ids;
#pragma omp for schedule(dynamic)
    for (int b = 0; b < blocks; ++b) {
      errors.guard(b, [&] {
        const int end = std::min(engine.groups(), (b + 1) * groups_per_block);
        for (int g = b * groups_per_block; g < end; ++g) {
          worker.search(b, g, order.of_group(engine, g, ids));
        }
      });
    }
  }
  errors.rethrow();
  return rows.finish();
}

/// The k nearest nodes of many queries.
template <int Dim, class Engine>
Stencils nearest_in_groups(const Engine& engine, const Points<Dim>& nodes,
                           const Points<Dim>& queries, int k, Ties ties) {
  return search_in_groups<Dim>(engine, nodes, queries, k, [&](StencilRows& rows) {
    return NearestWorker<Dim, Engine>(engine, nodes, queries, k, ties, rows);
  });
}

/// All nodes within a radius of each query.
template <int Dim, class Engine>
Stencils within_in_groups(const Engine& engine, const Points<Dim>& nodes,
                          const Points<Dim>& queries, std::span<const double> radii) {
  return search_in_groups<Dim>(engine, nodes, queries, 0, [&](StencilRows& rows) {
    return WithinWorker<Dim, Engine>(engine, nodes, queries, radii, rows);
  });
}

}  // namespace strongpoint
