#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "methods/core/box_tree.hpp"
#include "methods/core/hilbert.hpp"
#include "methods/core/neighbours_groups.hpp"

namespace strongpoint {

/// Buckets of consecutive nodes along a Hilbert curve, and above them a tree of boxes, each around
/// eight of the level below. Serves clouds of any density: buckets are small where nodes crowd.
template <int Dim>
class BucketEngine {
 public:
  explicit BucketEngine(const Points<Dim>& nodes) {
    if (nodes.cols() == 0) return;
    sorted_.assign(nodes, hilbert_order<Dim>(nodes));
    box_buckets();
    do {
      box_level();
    } while (levels_.back().count > fan);
    tree_.levels = static_cast<int>(levels_.size());
    for (int level = 0; level < tree_.levels; ++level) {
      for (int c = 0; c < Dim; ++c) {
        tree_.low[level][c] = levels_[level].low[c].data();
        tree_.high[level][c] = levels_[level].high[c].data();
      }
    }
  }

  /// Offers all nodes within the collector's bound.
  void visit(const Point<Dim>& query, CandidateCollector auto& collector) const {
    if (!levels_.empty()) visit_boxes(query, static_cast<int>(levels_.size()) - 1, 0, collector);
  }

  /// The nodes along the curve; a bucket is a group.
  const SortedNodes<Dim>& sorted() const { return sorted_; }
  int groups() const { return levels_.empty() ? 0 : levels_.front().count; }
  std::pair<int, int> group(int g) const {
    return {g * bucket_size, std::min((g + 1) * bucket_size, sorted_.size())};
  }
  /// The bucket reached by going to the nearest box on every level.
  int group_of(const Point<Dim>& x) const;
  /// Squared radius of a ball of about k nodes at the density of bucket g.
  double expected_square(int g, int k) const;
  /// Lists ranges, begin and end, of the sorted nodes that include all within `reach` of a box;
  /// returns how many. The list grows where it has to and is not cut back.
  int list_ranges(const Point<Dim>& low, const Point<Dim>& high, double reach,
                  std::vector<int>& ranges) const {
    if (levels_.empty()) return 0;
    // Boxes found stand at the end of the room, ranges grow from its beginning.
    const std::size_t room = static_cast<std::size_t>(groups());
    if (ranges.size() < 3 * room) ranges.resize(3 * room);
    int* const found = ranges.data() + 2 * room;
    int count = 0;
    BoxesNear task{&tree_, Dim, {}, {}, reach, found, &count};
    for (int c = 0; c < Dim; ++c) {
      const double slack = 1e-15 * (std::abs(low[c]) + std::abs(high[c]));
      task.low[c] = low[c] - slack;
      task.high[c] = high[c] + slack;
    }
    list_boxes_near(task);
    std::size_t filled = 0;
    for (int i = 0; i < count; ++i) {
      const auto [begin, end] = group(found[i]);
      if (filled > 0 && ranges[filled - 1] == begin) {
        ranges[filled - 1] = end;
      } else {
        ranges[filled++] = begin;
        ranges[filled++] = end;
      }
    }
    return static_cast<int>(filled / 2);
  }

 private:
  static constexpr int bucket_size = Dim == 2 ? 16 : 32;
  static constexpr int fan = BoxTree::fan;

  /// Boxes of one level, padded with empty ones to a multiple of `fan`.
  struct Level {
    int count = 0;
    std::array<std::vector<double>, Dim> low, high;
  };

  SortedNodes<Dim> sorted_;
  BoxTree tree_{};             ///< the same for kernels
  std::vector<Level> levels_;  ///< buckets first, then ever larger boxes, at most `fan` on top

  void add_level(int count) {
    const double infinity = std::numeric_limits<double>::infinity();
    const std::size_t room = static_cast<std::size_t>((count + fan - 1) / fan) * fan;
    Level level;
    level.count = count;
    for (int c = 0; c < Dim; ++c) {
      level.low[c].assign(room, infinity);
      level.high[c].assign(room, -infinity);
    }
    levels_.push_back(std::move(level));
  }
  void box_buckets() {
    add_level((sorted_.size() + bucket_size - 1) / bucket_size);
    Level& level = levels_.back();
    for (int b = 0; b < level.count; ++b) {
      const auto [begin, end] = group(b);
      for (int c = 0; c < Dim; ++c) {
        const double* const x = sorted_.coordinates[c].data();
        level.low[c][b] = *std::min_element(x + begin, x + end);
        level.high[c][b] = *std::max_element(x + begin, x + end);
      }
    }
  }
  void box_level() {
    add_level((levels_.back().count + fan - 1) / fan);
    const Level& below = levels_[levels_.size() - 2];
    Level& level = levels_.back();
    for (int b = 0; b < level.count; ++b) {
      for (int c = 0; c < Dim; ++c) {
        const auto low = below.low[c].begin() + b * fan;
        const auto high = below.high[c].begin() + b * fan;
        level.low[c][b] = *std::min_element(low, low + fan);
        level.high[c][b] = *std::max_element(high, high + fan);
      }
    }
  }
  /// Lower bounds of the squared distances from x to the `fan` boxes from `first` on.
  std::array<double, fan> squared_gaps(const Point<Dim>& x, int level, int first) const {
    std::array<double, fan> sum{};
    for (int c = 0; c < Dim; ++c) {
      const double* const low = levels_[level].low[c].data() + first;
      const double* const high = levels_[level].high[c].data() + first;
      for (int i = 0; i < fan; ++i) {
        const double gap = std::max(std::max(low[i] - x[c], x[c] - high[i]), 0.0);
        sum[i] += gap * gap;
      }
    }
    return sum;
  }
  void visit_boxes(const Point<Dim>& query, int level, int first,
                   CandidateCollector auto& collector) const;
};

template <int Dim>
int BucketEngine<Dim>::group_of(const Point<Dim>& x) const {
  int first = 0;
  for (int level = static_cast<int>(levels_.size()) - 1;; --level) {
    const std::array<double, fan> gaps = squared_gaps(x, level, first);
    const int nearest =
        first + static_cast<int>(std::min_element(gaps.begin(), gaps.end()) - gaps.begin());
    if (level == 0) return std::min(nearest, levels_[0].count - 1);
    first = nearest * fan;
  }
}

template <int Dim>
double BucketEngine<Dim>::expected_square(int g, int k) const {
  double measure = 1;
  int directions = 0;
  for (int c = 0; c < Dim; ++c) {
    const double extent = levels_[0].high[c][g] - levels_[0].low[c][g];
    if (!(extent > 0)) continue;
    measure *= extent;
    ++directions;
  }
  if (directions == 0) return 0;
  const auto [begin, end] = group(g);
  return square_of_ball(static_cast<double>(k) / (end - begin), std::pow(measure, 1.0 / directions),
                        directions);
}

template <int Dim>
void BucketEngine<Dim>::visit_boxes(const Point<Dim>& query, int level, int first,
                                    CandidateCollector auto& collector) const {
  const std::array<double, fan> gaps = squared_gaps(query, level, first);
  std::array<int, fan> order;
  int count = 0;
  for (int i = 0; i < std::min(fan, levels_[level].count - first); ++i) {
    int place = count++;
    for (; place > 0 && gaps[i] < gaps[order[place - 1]]; --place) order[place] = order[place - 1];
    order[place] = i;
  }
  for (int j = 0; j < count; ++j) {
    const int box = first + order[j];
    // Sums of rounded squares: neither they nor the distances are larger than they should be by
    // more than a few units in the last place.
    if (gaps[order[j]] * (1 - 1e-14) > collector.bound()) return;
    if (level > 0) {
      visit_boxes(query, level - 1, box * fan, collector);
      continue;
    }
    const auto [begin, end] = group(box);
    for (int i = begin; i < end; ++i) {
      Point<Dim> node;
      for (int c = 0; c < Dim; ++c) node[c] = sorted_.coordinates[c][i];
      const double d2 = squared_distance<Dim>(query, node);
      if (d2 <= collector.bound()) collector.offer({d2, sorted_.ids[i]});
    }
  }
}

}  // namespace strongpoint
