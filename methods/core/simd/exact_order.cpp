// Compiled without contraction: distances come out bitwise as `squared_distance` gives them.
#include "methods/core/nearest_group.hpp"
#include "methods/core/simd/key_lanes.hpp"
#include "methods/core/simd/key_sort.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Candidates of a query, ids ascending.
struct Ordered {
  int ids[GroupRoom::survivors + 16];
  double squares[GroupRoom::survivors + 16];
  double ranks[GroupRoom::survivors + 16];
};

/// Sorts up to 2^Bits ids.
template <int Bits>
void sort_ids(const int* ids, int count, int* sorted) {
  constexpr int registers = (1 << Bits) / narrow_lanes;
  Keys keys[registers];
  for (int r = 0; r < registers; ++r) {
    const int left = count - r * narrow_lanes;
    const Keys loaded = load_keys(ids + r * narrow_lanes);
    keys[r] = left >= narrow_lanes ? loaded
                                   : first_lanes(left < 0 ? 0 : left, loaded, all_keys(0x7fffffff));
  }
  sort_keys<registers>(keys);
  for (int r = 0; r < registers; ++r) store_keys(sorted + r * narrow_lanes, keys[r]);
}

template <int Dim>
void measure(const ExactOrder& task, int query, int count, Ordered& ordered) {
  double x[Dim];
  for (int c = 0; c < Dim; ++c) x[c] = task.queries[c][query];
  for (int i = 0; i < count; ++i) {
    const double* const node = task.nodes + static_cast<long>(ordered.ids[i]) * Dim;
    double sum = 0;
    for (int c = 0; c < Dim; ++c) sum += (x[c] - node[c]) * (x[c] - node[c]);
    ordered.squares[i] = sum;
  }
  for (int i = 0; i < lanes; ++i) ordered.squares[count + i] = __builtin_inf();
}

/// Counts for each candidate those that precede it by (square, place in the list).
void rank(int count, Ordered& ordered) {
  const Pack one = all(1);
  const Pack none = all(0);
  for (int first = 0; first < count; first += lanes) {
    const Pack own = load(ordered.squares + first);
    Pack preceding = none;
    for (int i = 0; i < first; ++i) {
      const unsigned nearer = less(own, all(ordered.squares[i]));
      preceding = preceding + choose(nearer, none, one);
    }
    for (int i = first; i < first + lanes; ++i) {
      const Pack other = all(ordered.squares[i]);
      const unsigned behind = every_lane & ~((2U << (i - first)) - 1);
      const unsigned bits = less(other, own) | (behind & ~less(own, other));
      preceding = preceding + choose(bits, one, none);
    }
    for (int i = first + lanes; i < count; ++i) {
      preceding = preceding + choose_less(all(ordered.squares[i]), own, one, none);
    }
    store(ordered.ranks + first, preceding);
  }
}

template <int Dim>
void order(const ExactOrder& task, int query, Ordered& ordered) {
  GroupRoom& room = *task.room;
  const int count = room.candidates[query];
  int* const ids = room.sorted[query];
  if (count <= 32) {
    sort_ids<5>(ids, count, ordered.ids);
  } else if (count <= 64) {
    sort_ids<6>(ids, count, ordered.ids);
  } else {
    sort_ids<7>(ids, count, ordered.ids);
  }
  measure<Dim>(task, query, count, ordered);
  rank(count, ordered);
  double squares[GroupRoom::survivors];
  for (int i = 0; i < count; ++i) {
    const int place = static_cast<int>(ordered.ranks[i]);
    ids[place] = ordered.ids[i];
    squares[place] = ordered.squares[i];
  }
  int size = task.k;
  if (task.bounds != nullptr) {
    while (size < count && squares[size] <= task.bounds[query]) ++size;
  } else if (task.tie_factor > 1) {
    const double bound = squares[task.k - 1] * task.tie_factor;
    while (size < count && squares[size] <= bound) ++size;
  }
  room.candidates[query] = size;
}

}  // namespace

void order_exactly(const ExactOrder& task) {
  Ordered ordered;
  for (int q = 0; q < task.query_count; ++q) {
    if (task.room->outcome[q] != GroupOutcome::ambiguous) continue;
    if (task.dim == 2) order<2>(task, q, ordered);
    if (task.dim == 3) order<3>(task, q, ordered);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
