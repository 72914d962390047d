#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace strongpoint {

/// Some columns of a wide matrix, listed in ascending order without sorting: a bit each, and a bit
/// for every 64 of these that are not all zero, and so on. Inserting costs nothing but a few bits,
/// listing grows with the columns that are in, whatever the width.
class ColumnSet {
 public:
  /// Makes room for columns 0 to width - 1 and empties the set.
  void resize(std::int64_t width) {
    levels_.clear();
    do {
      width = (width + 63) / 64;
      levels_.emplace_back(width, 0);
    } while (width > 1);
  }
  bool has_room() const { return !levels_.empty(); }
  /// Puts a column in; returns 1 when it was not in before, else 0.
  int insert(std::int64_t column) {
    const std::uint64_t bit = bit_of(column);
    std::uint64_t& word = levels_[0][column >> 6];
    if ((word & bit) != 0) return 0;
    if (word == 0) note(column >> 6);
    word |= bit;
    return 1;
  }
  /// Calls `visit(column)` for all columns, ascending, and empties the set.
  template <class Visit>
  void drain(const Visit& visit) {
    drain_level(static_cast<int>(levels_.size()) - 1, 0, visit);
  }

 private:
  std::vector<std::vector<std::uint64_t>> levels_;  ///< the last one has one word

  static std::uint64_t bit_of(std::int64_t place) { return std::uint64_t{1} << (place & 63); }
  void note(std::int64_t place) {
    for (std::size_t level = 1; level < levels_.size(); ++level, place >>= 6) {
      std::uint64_t& word = levels_[level][place >> 6];
      const bool was_empty = word == 0;
      word |= bit_of(place);
      if (!was_empty) return;
    }
  }
  template <class Visit>
  void drain_level(int level, std::int64_t place, const Visit& visit) {
    std::uint64_t word = levels_[level][place];
    levels_[level][place] = 0;
    for (; word != 0; word &= word - 1) {
      const std::int64_t below = place * 64 + std::countr_zero(word);
      if (level == 0) {
        visit(below);
      } else {
        drain_level(level - 1, below, visit);
      }
    }
  }
};

}  // namespace strongpoint
