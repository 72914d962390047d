#include "problems/core/frontal_plan.hpp"

#include <algorithm>

namespace strongpoint {

std::vector<FrontStep> plan_fronts(const NodeGraph& graph, std::span<const int> order,
                                   int at_once) {
  constexpr int outside = -1;
  const auto count = static_cast<int>(order.size());
  std::vector<int> place(count, outside);
  std::vector<int> front;
  std::vector<char> is_done(count, 0);
  std::vector<FrontStep> steps;
  for (int begin = 0; begin < count; begin += at_once) {
    FrontStep step{begin, std::min(begin + at_once, count), {}, {}, {}};
    const auto enter = [&](int node) {
      if (place[node] != outside || is_done[node] != 0) return;
      place[node] = static_cast<int>(front.size());
      front.push_back(node);
      step.entering.push_back(node);
    };
    for (int i = step.begin; i < step.end; ++i) {
      enter(order[i]);
      for (const int other : graph.of(order[i])) enter(other);
    }
    auto last = static_cast<int>(front.size());
    for (int i = step.end - 1; i >= step.begin; --i) {
      --last;
      const int from = place[order[i]];
      if (from == last) continue;
      step.exchanges.emplace_back(from, last);
      std::swap(front[from], front[last]);
      place[front[from]] = from;
      place[front[last]] = last;
    }
    step.nodes = front;
    for (int i = step.begin; i < step.end; ++i) {
      is_done[order[i]] = 1;
      place[order[i]] = outside;
    }
    front.resize(last);
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace strongpoint
