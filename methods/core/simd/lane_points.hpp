#pragma once

#include "methods/core/simd/lane_anchors.hpp"
#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/taylor_kernel.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Where the weights of some lanes go.
struct LaneRows {
  double* to[lanes];   ///< null for the other lanes
  int entries[lanes];  ///< numbers of each; 0 for the other lanes
  int least;           ///< numbers that all of them have
};

/// The points of a group of anchors.
template <int Dim>
class LanePoints {
 public:
  LanePoints(const StencilTable& table, const PointTable& points, int first)
      : table_(table), points_(points), anchors_(anchors_of(table, first)) {
    for (int lane = 0; lane < lanes; ++lane) {
      list_[lane] = points.offsets[anchors_.of[lane]];
      count_[lane] = points.offsets[anchors_.of[lane] + 1] - list_[lane];
    }
    in_a_row_ = anchors_.in_a_row && are_in_a_row();
  }

  const LaneAnchors& anchors() const { return anchors_; }

  /// The most points that one of some lanes has.
  long most(unsigned some) const {
    if (in_a_row_) return some == 0 ? 0 : 1;
    long most = 0;
    for (int lane = 0; lane < lanes; ++lane) {
      if ((some >> lane & 1U) != 0) most = count_[lane] > most ? count_[lane] : most;
    }
    return most;
  }
  /// Bits of the lanes that have a p-th point.
  unsigned with(long p) const {
    if (in_a_row_) return every_lane;
    unsigned bits = 0;
    for (int lane = 0; lane < lanes; ++lane) bits |= (p < count_[lane] ? 1U : 0U) << lane;
    return bits;
  }
  /// True only when there is one point a lane, and it lies at the anchor.
  bool are_anchors() const {
    if (!in_a_row_) return false;
    const double* const points = points_.points + static_cast<long>(id(0, 0)) * Dim;
    const double* const anchors = table_.anchors + static_cast<long>(anchors_.of[0]) * Dim;
    Pack farthest = all(0);
    for (int c = 0; c < Dim; ++c) {
      const Pack apart = load(points + static_cast<long>(c) * lanes) -
                         load(anchors + static_cast<long>(c) * lanes);
      farthest = max(farthest, abs(apart));
    }
    return less(all(0), farthest) == 0;
  }
  /// The p-th point of each lane, relative to the anchor. Lanes without one get their last, or the
  /// anchor.
  void find(long p, Pack* at) const {
    const double* place[lanes];
    const double* origin[lanes];
    for (int lane = 0; lane < lanes; ++lane) {
      origin[lane] = table_.anchors + static_cast<long>(anchors_.of[lane]) * Dim;
      const long last = count_[lane] - 1;
      place[lane] = last < 0
                        ? origin[lane]
                        : points_.points + static_cast<long>(id(lane, p < last ? p : last)) * Dim;
    }
    Pack from[Dim];
    load_nodes<Dim>(place, at);
    fetch_ahead(place[0]);
    fetch_ahead(place[lanes / 2]);
    load_nodes<Dim>(origin, from);
    for (int c = 0; c < Dim; ++c) at[c] = at[c] - from[c];
  }
  /// Where the rows of the p-th points of some lanes go, given numbers for each entry.
  LaneRows rows(long p, unsigned some, int per_entry) const {
    LaneRows rows;
    rows.least = table_.size * per_entry;
    for (int lane = 0; lane < lanes; ++lane) {
      rows.to[lane] = nullptr;
      rows.entries[lane] = 0;
      if ((some >> lane & 1U) == 0) continue;
      const std::int64_t* const row = points_.rows + id(lane, p);
      rows.to[lane] = points_.values + row[0] * per_entry;
      rows.entries[lane] = static_cast<int>(row[1] - row[0]) * per_entry;
      rows.least = rows.entries[lane] < rows.least ? rows.entries[lane] : rows.least;
    }
    return rows;
  }
  /// Where all rows go when they lie one after the other and have the table's size each; null
  /// otherwise.
  double* piece(unsigned some, int per_entry) const {
    if (!in_a_row_ || some != every_lane) return nullptr;
    return points_.values + points_.rows[id(0, 0)] * per_entry;
  }

 private:
  const StencilTable& table_;
  const PointTable& points_;
  LaneAnchors anchors_;
  std::int64_t list_[lanes];   ///< where each lane's begins
  std::int64_t count_[lanes];  ///< points of each lane
  bool in_a_row_;              ///< anchors, one point each, and their rows

  int id(int lane, long p) const { return points_.ids[list_[lane] + p]; }

  bool are_in_a_row() const {
    std::int64_t strays = 0;
#pragma GCC unroll 8
    for (int lane = 0; lane < lanes; ++lane) {
      strays |= (list_[lane] - list_[0] - lane) | (count_[lane] - 1);
    }
    if (strays != 0) return false;
    const int* const ids = points_.ids + list_[0];
    for (int lane = 0; lane < lanes; ++lane) strays |= ids[lane] - ids[0] - lane;
    if (strays != 0) return false;
    const std::int64_t* const rows = points_.rows + ids[0];
    for (int lane = 1; lane <= lanes; ++lane) {
      strays |= rows[lane] - rows[0] - static_cast<std::int64_t>(lane) * table_.size;
    }
    return strays == 0;
  }
};

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
