#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace strongpoint {

/// Stencils ordered by their sizes, so that those treated side by side need little padding.
class SizeOrder {
 public:
  struct Entry {
    int size;   ///< nodes in the stencil
    int place;  ///< where it is asked for
    friend bool operator<(const Entry& a, const Entry& b) {
      return a.size != b.size ? a.size < b.size : a.place < b.place;
    }
  };

  /// Begins anew, for `most` stencils at most.
  void begin(std::size_t most) {
    entries_.resize(most);
    count_ = 0;
    last_size_ = 0;
    sorted_ = true;
  }
  /// Adds a stencil; places ascend.
  void add(int size, int place) {
    sorted_ = sorted_ && last_size_ <= size;
    last_size_ = size;
    entries_[count_++] = {size, place};
  }
  /// What was added, by size, then by place.
  std::span<const Entry> arrange() {
    const std::span<Entry> entries(entries_.data(), count_);
    return sorted_ ? entries : arranged(entries);
  }

 private:
  std::vector<Entry> entries_, arranged_;
  std::vector<int> next_;  ///< where the next stencil of each size goes, from the least size on
  std::size_t count_ = 0;
  int last_size_ = 0;
  bool sorted_ = true;

  std::span<const Entry> arranged(std::span<Entry> entries) {
    constexpr std::size_t sparse = 8;  // sizes a stencil from which on counting them takes longer
    const auto [least, most] = std::minmax_element(entries.begin(), entries.end());
    const int first = least->size;
    const std::size_t sizes = most->size - first + 1;
    if (sizes > sparse * entries.size()) {
      std::sort(entries.begin(), entries.end());
      return entries;
    }
    next_.assign(sizes + 1, 0);
    for (const Entry& entry : entries) ++next_[entry.size - first + 1];
    for (std::size_t s = 1; s < sizes; ++s) next_[s] += next_[s - 1];
    arranged_.resize(entries.size());
    for (const Entry& entry : entries) arranged_[next_[entry.size - first]++] = entry;
    return arranged_;
  }
};

}  // namespace strongpoint
