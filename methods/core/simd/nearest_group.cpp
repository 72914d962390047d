#include "methods/core/nearest_group.hpp"

#include "methods/core/simd/key_lanes.hpp"
#include "methods/core/simd/key_sort.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

constexpr int last_key = 0x7fffffff;

/// Lists the nodes within reach of the box, in units of reach about its middle; returns how many.
template <int Dim>
int list_nodes(const NearestGroup& task) {
  const Pack inverse = all(1 / task.reach);
  Pack middle[Dim], half[Dim];
  for (int c = 0; c < Dim; ++c) {
    middle[c] = all(task.middle[c]);
    half[c] = all(task.half[c]) * inverse;
  }
  const Pack limit = all(1 + 1e-9);  // round-off must not lose a node on the rim
  const double* nodes[Dim];
  float* list[Dim];
  for (int c = 0; c < Dim; ++c) {
    nodes[c] = task.nodes[c];
    list[c] = task.list[c];
  }
  const int* const ids = task.ids;
  int* const list_ids = task.list_ids;
  int count = 0;
  for (int r = 0; r < task.range_count; ++r) {
    const int end = task.ranges[2 * r + 1];
    for (int i = task.ranges[2 * r]; i < end; i += lanes) {
      Pack place[Dim];
      Pack square = all(0);
      for (int c = 0; c < Dim; ++c) {
        place[c] = (load(nodes[c] + i) - middle[c]) * inverse;
        const Pack gap = max(abs(place[c]) - half[c], all(0));
        square = square + gap * gap;
      }
      unsigned bits = less(square, limit);
      if (end - i < lanes) bits &= (1U << (end - i)) - 1;
      for (int c = 0; c < Dim; ++c) append_rounded(list[c] + count, place[c], bits);
      append_integers(list_ids + count, ids + i, bits);
      count += __builtin_popcount(bits);
    }
  }
  return count;
}

/// Gathers the listed nodes within `radius` (over reach, squared) of a query.
template <int Dim>
void gather_survivors(const NearestGroup& task, int count, int query, float radius) {
  GroupRoom& room = *task.room;
  float* const squares = room.squares[query];
  int* const ids = room.ids[query];
  const int* const list_ids = task.list_ids;
  const float* list[Dim];
  Floats x[Dim];
  for (int c = 0; c < Dim; ++c) {
    list[c] = task.list[c];
    const double place = (task.queries[c][query] - task.middle[c]) * (1 / task.reach);
    x[c] = all_floats(static_cast<float>(place));
  }
  const Floats limit = all_floats(radius);
  int found = 0;
  for (int i = 0; i < count; i += narrow_lanes) {
    Floats square = all_floats(0);
    for (int c = 0; c < Dim; ++c) {
      const Floats difference = load_floats(list[c] + i) - x[c];
      square = square + difference * difference;
    }
    const unsigned bits = at_most(square, limit);
    append_floats(squares + found, square, bits);
    append_keys(ids + found, list_ids + i, bits);
    found += __builtin_popcount(bits);
    if (found > GroupRoom::survivors) break;
  }
  room.found[query] = found;
}

/// How many lanes of a register are used when so many numbers are left.
int lanes_left(int left) { return left < 0 ? 0 : left < narrow_lanes ? left : narrow_lanes; }

/// Sorts a query's survivors, of which there are at most 2^Bits. `tolerance` is the least
/// difference of squared distances, in units of reach^2, that is sure.
template <int Bits>
void sort_survivors(const NearestGroup& task, int query, float radius, double tolerance) {
  GroupRoom& room = *task.room;
  constexpr int registers = (1 << Bits) / narrow_lanes;
  constexpr int top = (1 << (31 - Bits)) - 16;
  const int found = room.found[query];
  const float scale = static_cast<float>(top) / radius;
  const int sure = (static_cast<int>(tolerance * scale) + 17) << Bits;
  Keys keys[registers + 1];
  for (int r = 0; r < registers; ++r) {
    const int first = r * narrow_lanes;
    const Floats squares = load_floats(room.squares[query] + first) * all_floats(scale);
    keys[r] =
        first_lanes(lanes_left(found - first), keys_of<Bits>(squares, first), all_keys(last_key));
  }
  sort_keys<registers>(keys);
  keys[registers] = all_keys(last_key);
  unsigned close = 0;
  for (int r = 0; r < registers && r * narrow_lanes < task.k; ++r) {
    const Keys steps = subtract(shift_in(keys[r], keys[r + 1]), keys[r]);
    const int left = lanes_left(task.k - r * narrow_lanes);
    close |= less_keys(steps, all_keys(sure)) & ((1U << left) - 1);
  }
  if (close == 0) {
    for (int r = 0; r < registers && r * narrow_lanes < task.k; ++r) {
      store_first(task.rows[query] + r * narrow_lanes, lanes_left(task.k - r * narrow_lanes),
                  look_up<Bits>(keys[r], room.ids[query]));
    }
    room.outcome[query] = GroupOutcome::found;
    return;
  }
  int in_order[1 << Bits];
  for (int r = 0; r < registers; ++r) {
    store_keys(in_order + r * narrow_lanes, keys[r]);
    store_keys(room.sorted[query] + r * narrow_lanes, look_up<Bits>(keys[r], room.ids[query]));
  }
  const int kth = in_order[task.k - 1];
  room.outcome[query] = GroupOutcome::few;
  if (kth > last_key - 2 * sure) return;
  int candidates = task.k;
  while (candidates < found && in_order[candidates] - kth < sure) ++candidates;
  room.outcome[query] = GroupOutcome::ambiguous;
  room.candidates[query] = candidates;
}

/// Bound of the error of a squared distance between listed nodes and queries, in units of reach^2:
/// places are rounded to 2^-24 of their largest value, so is what is computed from them.
template <int Dim>
double rounding_error(const NearestGroup& task, double radius) {
  double largest = 0;
  for (int c = 0; c < Dim; ++c) {
    const double extent = task.half[c] / task.reach + 1;
    largest = extent > largest ? extent : largest;
  }
  const double unit = 0x1p-24;
  const double of_difference = unit * (2 * largest + radius) * 1.01;
  return Dim * (2 * radius + of_difference) * of_difference + (Dim + 2) * unit * radius * radius;
}

/// Gathers every query's survivors; `limits` are set to what each was given.
template <int Dim>
void gather_all(const NearestGroup& task, int count, float* limits) {
  GroupRoom& room = *task.room;
  float limit = task.limit;
  room.retries = 0;
  for (int q = 0; q < task.query_count; ++q) {
    limits[q] = limit;
    gather_survivors<Dim>(task, count, q, limit);
    const float excess = static_cast<float>(room.found[q]) / task.target - 1;
    const float follow = 1 - task.gain * (excess < 0.5F ? excess : 0.5F);
    limit = limit * follow < 1 ? limit * follow : 1;
    if (room.found[q] < task.k) {
      ++room.retries;
      limits[q] = 1;
      gather_survivors<Dim>(task, count, q, 1);
    }
    for (int i = 0; i < 3 && room.found[q] > GroupRoom::survivors; ++i) {
      limits[q] *= 0.7F;
      gather_survivors<Dim>(task, count, q, limits[q]);
    }
  }
  room.limit = limit;
}

/// Gathers what may lie within each query's bound.
template <int Dim>
void gather_bounded(const NearestGroup& task, int count) {
  GroupRoom& room = *task.room;
  const double error = rounding_error<Dim>(task, 1);
  for (int q = 0; q < task.query_count; ++q) {
    const double square = task.bounds[q] / task.reach / task.reach;
    gather_survivors<Dim>(task, count, q, static_cast<float>(square + 2 * error));
    const int found = room.found[q];
    room.outcome[q] = found > GroupRoom::survivors ? GroupOutcome::many : GroupOutcome::ambiguous;
    if (found > GroupRoom::survivors) continue;
    room.candidates[q] = found;
    for (int i = 0; i < found; ++i) room.sorted[q][i] = room.ids[q][i];
  }
}

template <int Dim>
void search(const NearestGroup& task) {
  GroupRoom& room = *task.room;
  const int count = list_nodes<Dim>(task);
  for (int c = 0; c < Dim; ++c) {
    for (int i = 0; i < narrow_lanes; ++i) task.list[c][count + i] = 1e30F;
  }
  if (task.bounds != nullptr) return gather_bounded<Dim>(task, count);
  float limits[group_size];
  gather_all<Dim>(task, count, limits);
  const double tolerance = 2 * rounding_error<Dim>(task, 1);
  for (int q = 0; q < task.query_count; ++q) {
    const int found = room.found[q];
    if (found < task.k) {
      room.outcome[q] = GroupOutcome::few;
    } else if (found <= 32) {
      sort_survivors<5>(task, q, limits[q], tolerance);
    } else if (found <= 64) {
      sort_survivors<6>(task, q, limits[q], tolerance);
    } else if (found <= GroupRoom::survivors) {
      sort_survivors<7>(task, q, limits[q], tolerance);
    } else {
      room.outcome[q] = GroupOutcome::many;
    }
  }
}

}  // namespace

void nearest_of_group(const NearestGroup& task) {
  if (task.dim == 2) search<2>(task);
  if (task.dim == 3) search<3>(task);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
