#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "methods/core/candidate.hpp"
#include "methods/core/neighbours.hpp"

namespace strongpoint {

/// Squared distance, summed over the components in order: every engine uses this one formula, so
/// that their results agree bitwise.
template <int Dim, class A, class B>
double squared_distance(const A& a, const B& b) {
  double sum = 0;
  for (int c = 0; c < Dim; ++c) {
    const double difference = a[c] - b[c];
    sum += difference * difference;
  }
  return sum;
}

/// What gathers the nodes that an engine offers for one query.
template <class C>
concept CandidateCollector = requires(C& collector, const C& view, Candidate candidate) {
  { view.bound() } -> std::convertible_to<double>;
  { view.expected() } -> std::convertible_to<int>;
  {collector.offer(candidate)};
};

/// Gathers the k nearest nodes and, if asked to, those that tie with the last of them.
class NearestCollector {
 public:
  NearestCollector(int k, Ties ties)
      : k_(static_cast<std::size_t>(k)),
        tie_factor_(ties == Ties::keep ? (1 + tie_tolerance) * (1 + tie_tolerance) : 1.0) {}

  /// Forgets the last query; the memory stays.
  void clear() {
    nearest_.clear();
    tied_.clear();
    tied_limit_ = 64;
    bound_ = std::numeric_limits<double>::infinity();
  }
  /// Squared distance above which a node cannot belong to the result; shrinks as nodes are offered.
  double bound() const { return bound_; }
  /// How many nodes the caller hopes for.
  int expected() const { return static_cast<int>(k_); }
  /// Takes a node whose squared distance is at most `bound()`, each node once.
  void offer(Candidate candidate) {
    if (nearest_.size() < k_) {
      nearest_.push_back(candidate);
      settle_last();
      if (nearest_.size() == k_) bound_ = farthest().squared_distance * tie_factor_;
      return;
    }
    if (candidate < farthest()) {
      candidate = replace_farthest(candidate);
      bound_ = farthest().squared_distance * tie_factor_;
    }
    if (tie_factor_ > 1 && candidate.squared_distance <= bound_) keep_tied(candidate);
  }
  /// The result, sorted.
  std::span<const Candidate> finish() {
    drop_beyond_bound();
    const bool in_order = is_small() && tied_.empty();
    nearest_.insert(nearest_.end(), tied_.begin(), tied_.end());
    if (!in_order) std::sort(nearest_.begin(), nearest_.end());
    return nearest_;
  }

 private:
  std::size_t k_;
  double tie_factor_;
  double bound_ = std::numeric_limits<double>::infinity();
  std::vector<Candidate> nearest_;  ///< so far, at most k: sorted if k is small, else a heap
  std::vector<Candidate> tied_;     ///< beyond them, but within the bound when they were met
  std::size_t tied_limit_ = 64;     ///< size of `tied_` at which it is cleaned

  /// An insertion into a sorted array moves k/2 entries, which for the usual stencils costs less
  /// than the branches of a heap.
  bool is_small() const { return k_ <= 128; }
  const Candidate& farthest() const { return is_small() ? nearest_.back() : nearest_.front(); }
  /// Moves the last entry to its place.
  void settle_last() {
    if (!is_small()) {
      std::push_heap(nearest_.begin(), nearest_.end());
      return;
    }
    const Candidate candidate = nearest_.back();
    std::size_t place = nearest_.size() - 1;
    for (; place > 0 && candidate < nearest_[place - 1]; --place) {
      nearest_[place] = nearest_[place - 1];
    }
    nearest_[place] = candidate;
  }
  /// Puts a candidate in the farthest one's stead and returns that.
  Candidate replace_farthest(Candidate candidate) {
    if (!is_small()) std::pop_heap(nearest_.begin(), nearest_.end());
    std::swap(candidate, nearest_.back());
    settle_last();
    return candidate;
  }

  void keep_tied(Candidate candidate) {
    if (tied_.size() >= tied_limit_) {
      drop_beyond_bound();
      tied_limit_ = std::max<std::size_t>(64, 2 * tied_.size());
    }
    tied_.push_back(candidate);
  }
  void drop_beyond_bound() {
    std::erase_if(tied_, [this](const Candidate& c) { return c.squared_distance > bound_; });
  }
};

/// Gathers all nodes within a radius, the bound included.
class RadiusCollector {
 public:
  /// Starts a query; a negative radius takes nothing.
  void clear(double radius) {
    bound_ = radius < 0 ? -1 : radius * radius;
    found_.clear();
  }
  double bound() const { return bound_; }
  int expected() const { return 1; }
  void offer(Candidate candidate) { found_.push_back(candidate); }
  /// The result, sorted.
  std::span<const Candidate> finish() {
    std::sort(found_.begin(), found_.end());
    return found_;
  }

 private:
  double bound_ = 0;
  std::vector<Candidate> found_;
};

/// A search engine: offers each node within the collector's bound, once. The bound may shrink with
/// every offer, and nodes beyond it must not be offered. Built from the nodes, which outlive it.
template <class E, int Dim>
concept NeighbourEngine = std::constructible_from < E,
        const Points<Dim>
& > &&requires(const E& engine, const Point<Dim>& query, NearestCollector& nearest,
               RadiusCollector& within) {
  engine.visit(query, nearest);
  engine.visit(query, within);
};

}  // namespace strongpoint
