#include "problems/core/front_order.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace strongpoint {
namespace {

/// Where a node stands.
enum class State : std::uint8_t {
  away,    ///< far from the front
  beside,  ///< coupled to the front
  inside,  ///< coupled to a node that has a number
  done     ///< has a number
};

class Sweep {
 public:
  explicit Sweep(const NodeGraph& graph)
      : graph_(graph),
        states_(graph.size(), State::away),
        priorities_(graph.size()),
        distances_(graph.size(), unreached) {
    order_.reserve(graph.size());
  }

  std::vector<int> run() {
    for (int node = 0; node < graph_.size(); ++node) {
      if (states_[node] != State::done) sweep_component(node);
    }
    return std::move(order_);
  }

 private:
  static constexpr int unreached = -1;
  static constexpr int weight_of_distance = 1;  // Sloan's
  static constexpr int weight_of_degree = 2;

  const NodeGraph& graph_;
  std::vector<State> states_;
  std::vector<int> priorities_;
  std::vector<int> distances_;  ///< from the last start
  std::vector<int> reached_;    ///< by the last start, nearest first
  std::vector<int> waiting_;    ///< beside and inside
  std::vector<int> order_;

  /// Finds the distances of a component from a node; returns the largest.
  int spread(int start) {
    for (const int node : reached_) distances_[node] = unreached;
    reached_.assign(1, start);
    distances_[start] = 0;
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      for (const int other : graph_.of(reached_[i])) {
        if (distances_[other] != unreached) continue;
        distances_[other] = distances_[reached_[i]] + 1;
        reached_.push_back(other);
      }
    }
    return distances_[reached_.back()];
  }

  /// The node of least degree among those farthest from the last start.
  int far_end() const {
    const int depth = distances_[reached_.back()];
    int best = reached_.back();
    for (auto i = reached_.rbegin(); i != reached_.rend() && distances_[*i] == depth; ++i) {
      if (graph_.degree(*i) < graph_.degree(best)) best = *i;
    }
    return best;
  }

  void sweep_component(int node) {
    int start = node;
    int depth = spread(start);
    for (;;) {  // until the two are as far apart as can be told
      const int end = far_end();
      const int farther = spread(end);
      if (farther <= depth) break;
      start = end;
      depth = farther;
    }
    for (const int reached : reached_) {  // distances from the end
      priorities_[reached] = weight_of_distance * distances_[reached] -
                             weight_of_degree * (graph_.degree(reached) + 1);
    }
    states_[start] = State::beside;
    waiting_.assign(1, start);
    while (!waiting_.empty()) number(take_best());
    for (const int reached : reached_) distances_[reached] = unreached;
    reached_.clear();
  }

  int take_best() {
    std::size_t best = 0;
    for (std::size_t i = 1; i < waiting_.size(); ++i) {
      if (priorities_[waiting_[i]] > priorities_[waiting_[best]]) best = i;
    }
    const int node = waiting_[best];
    waiting_[best] = waiting_.back();
    waiting_.pop_back();
    return node;
  }

  /// Raises the nodes that a node newly in the front is coupled with.
  void raise_neighbours(int node) {
    for (const int other : graph_.of(node)) {
      if (states_[other] == State::done) continue;
      priorities_[other] += weight_of_degree;
      if (states_[other] != State::away) continue;
      states_[other] = State::beside;
      waiting_.push_back(other);
    }
  }

  void number(int node) {
    if (states_[node] == State::beside) raise_neighbours(node);
    order_.push_back(node);
    states_[node] = State::done;
    for (const int other : graph_.of(node)) {
      if (states_[other] != State::beside) continue;
      states_[other] = State::inside;
      priorities_[other] += weight_of_degree;
      raise_neighbours(other);
    }
  }
};

}  // namespace

std::vector<int> front_order(const NodeGraph& graph) { return Sweep(graph).run(); }

}  // namespace strongpoint
