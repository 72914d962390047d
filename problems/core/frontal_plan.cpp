#include "problems/core/frontal_plan.hpp"

#include <algorithm>

namespace strongpoint {
namespace {

constexpr int outside = -1;
constexpr int entered = -2;  // in the front, at no place yet

/// Takes nodes out of the front and closes the gaps.
void take_out(std::span<const int> nodes, std::vector<int>& place, std::vector<int>& front,
              FrontStep& step) {
  for (const int node : nodes) {
    step.pivots.push_back(place[node]);
    front[place[node]] = outside;
    place[node] = outside;
  }
  const std::size_t rest = front.size() - nodes.size();
  std::size_t gap = 0;
  for (std::size_t from = rest; from < front.size(); ++from) {
    if (front[from] == outside) continue;
    while (front[gap] != outside) ++gap;
    step.moves.emplace_back(from, gap);
    front[gap] = front[from];
    place[front[gap]] = static_cast<int>(gap);
  }
  front.resize(rest);
  step.nodes = front;
  step.nodes.insert(step.nodes.end(), nodes.begin(), nodes.end());
}

}  // namespace

std::vector<FrontStep> plan_fronts(const NodeGraph& graph, std::span<const int> order,
                                   int at_once) {
  const auto count = static_cast<int>(order.size());
  std::vector<int> place(count, outside);
  std::vector<int> front;
  std::vector<FrontStep> steps;
  std::vector<int> turn(count);  // of each node
  for (int i = 0; i < count; ++i) turn[order[i]] = i;
  for (int begin = 0; begin < count; begin += at_once) {
    FrontStep step{begin, std::min(begin + at_once, count), {}, {}, {}, {}};
    const auto enter = [&](int node) {
      if (place[node] != outside || turn[node] < begin) return;
      place[node] = entered;
      step.entering.push_back(node);
    };
    for (int i = step.begin; i < step.end; ++i) {
      enter(order[i]);
      for (const int other : graph.of(order[i])) enter(other);
    }
    // Nodes that leave together shall lie together.
    std::sort(step.entering.begin(), step.entering.end(),
              [&](int a, int b) { return turn[a] < turn[b]; });
    for (const int node : step.entering) {
      place[node] = static_cast<int>(front.size());
      front.push_back(node);
    }
    take_out(std::span(order).subspan(step.begin, step.end - step.begin), place, front, step);
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace strongpoint
