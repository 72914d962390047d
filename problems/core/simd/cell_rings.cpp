#include "problems/core/simd/cell_rings.hpp"

#include "problems/core/simd/nearest_crossing.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

constexpr double infinity = __builtin_inf();

/// Places up to which neighbours are looked at before asking which others can matter, and how many
/// are then looked at at a time.
constexpr int first_look = 13;
constexpr int next_look = 4;

/// More than the round-off of a squared distance.
constexpr double slack = 1 + 1e-12;

/// Positions relative to their nodes, a node a lane.
struct Arms {
  Pack x[most_ring_neighbours];
  Pack y[most_ring_neighbours];
};

/// The point of a bisector where another one crosses it.
struct Corner {
  Pack x, y;
  Pack next;  ///< place of the node whose bisector goes on from there
};

/// Row of the task that a lane treats; the last one is repeated where the group is not full.
int row_of(const RingTask& task, int first, int lane) {
  return first + lane < task.count ? first + lane : task.count - 1;
}

void gather(const RingTask& task, int first, Arms& arms) {
  const int* ids[lanes];
  const double* node[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    const int row = row_of(task, first, lane);
    ids[lane] = task.ids + task.offsets[row];
    node[lane] = task.nodes + 2 * static_cast<long>(task.chosen[row]);
  }
  Pack origin[2];
  load_nodes<2>(node, origin);
  for (int j = 0; j < task.size; ++j) {
    for (int lane = 0; lane < lanes; ++lane) {
      node[lane] = task.nodes + 2 * static_cast<long>(ids[lane][j]);
    }
    Pack place[2];
    load_nodes<2>(node, place);
    arms.x[j] = place[0] - origin[0];
    arms.y[j] = place[1] - origin[1];
  }
}

/// Looks at the bisector of arm j.
inline void look(const Arms& arms, int j, Pack ax, Pack ay, Pack place, Nearest& nearest) {
  const Pack bx = arms.x[j];
  const Pack by = arms.y[j];
  const Pack x = bx - ax;
  const Pack y = by - ay;
  // a x (b - a): exactly zero for a itself, which fused products of a x b are not.
  const Pack cross = ax * y - ay * x;
  const Pack crosses = choose_less(all(0), cross, bx * x + by * y, all(infinity));
  compare(crosses, cross, place, nearest);
}

/// Follows the bisector of the arm (ax, ay) counter-clockwise from a point of the cell, whose
/// square is given, to the nearest crossing. The bisector is a/2 + t/2 (-ay, ax); that of b crosses
/// it at t = b.(b - a) / (a x b), from inside where the cross product is positive. Not finite where
/// none does. Only the lanes in `on` count.
inline Corner next_corner(const Arms& arms, int size, Pack ax, Pack ay, Pack from_squared,
                          unsigned on) {
  // Two of them: each waits for itself only.
  Nearest nearest{all(infinity), all(1), all(0)}, odd = nearest;
  Corner corner{all(0), all(0), all(0)};
  Pack place = all(1);
  for (int j = 1, end = first_look; j < size; end += next_look) {
    end = end < size ? end : size;
    for (; j + 1 < end; j += 2) {
      look(arms, j, ax, ay, place, nearest);
      look(arms, j + 1, ax, ay, place + all(1), odd);
      place = place + all(2);
    }
    if (j < end) {
      look(arms, j++, ax, ay, place, nearest);
      place = place + all(1);
    }
    compare(odd.above, odd.below, odd.place, nearest);
    const Pack t = nearest.above / nearest.below;
    corner.x = all(0.5) * (ax - t * ay);
    corner.y = all(0.5) * (ay + t * ax);
    if (j >= size) break;
    // A bisector that passes between the two ends is at most as far away as the farther of them.
    const Pack square =
        choose_less(t, all(infinity), corner.x * corner.x + corner.y * corner.y, all(infinity));
    const Pack limit = all(4 * slack) * max(from_squared, square);
    const Pack x = arms.x[j], y = arms.y[j];
    if ((less(x * x + y * y, limit) & on) == 0) break;
  }
  corner.next = nearest.place;
  return corner;
}

/// Goes on to the next node of each lane in `on`; returns the lanes that are not back at the first.
unsigned turn(const Arms& arms, const Corner& corner, unsigned on, Pack& ax, Pack& ay) {
  double next[lanes];
  store(next, corner.next);
  const double* x[lanes];
  const double* y[lanes];
  unsigned back = 0;
  for (int lane = 0; lane < lanes; ++lane) {
    const int place = static_cast<int>(next[lane]);
    x[lane] = reinterpret_cast<const double*>(arms.x + place) + lane;
    y[lane] = reinterpret_cast<const double*>(arms.y + place) + lane;
    back |= static_cast<unsigned>(place == 1) << lane;
  }
  load_nodes<1>(x, &ax);
  load_nodes<1>(y, &ay);
  return on & ~back;
}

/// Writes a corner of each lane in `on` into the rings.
void keep_corner(const RingTask& task, int first, int step, unsigned on, const Corner& corner) {
  double x[lanes], y[lanes], next[lanes];
  store(x, corner.x);
  store(y, corner.y);
  store(next, corner.next);
  for (int lane = 0; lane < lanes && first + lane < task.count; ++lane) {
    if ((on >> lane & 1U) == 0) continue;
    const long row = first + lane;
    const long at = row * most_ring_corners + step;
    task.ring_corners[2 * at] = x[lane];
    task.ring_corners[2 * at + 1] = y[lane];
    task.ring_places[at] = static_cast<int>(next[lane]);
    task.ring_sizes[row] = step + 1;
  }
}

void walk_around(const RingTask& task, int first, const Arms& arms) {
  Pack ax = arms.x[1];
  Pack ay = arms.y[1];
  Pack first_x = all(0), first_y = all(0), last_x = all(0), last_y = all(0);
  Pack twice_area = all(0);
  Pack farthest = all(0);
  // Lanes whose nearest node is at their own place never start.
  unsigned bounded = less(all(0), ax * ax + ay * ay);
  unsigned on = bounded;
  Pack from_squared = all(0.25) * (ax * ax + ay * ay);
  for (int step = 0; step < most_ring_corners && on != 0; ++step) {
    const Corner corner = next_corner(arms, task.size, ax, ay, from_squared, on);
    if (step == 0) {
      first_x = corner.x;
      first_y = corner.y;
    } else {
      twice_area = choose(on, twice_area + (last_x * corner.y - last_y * corner.x), twice_area);
    }
    from_squared = corner.x * corner.x + corner.y * corner.y;
    farthest = choose(on, max(farthest, from_squared), farthest);
    bounded &= less(farthest, all(infinity));
    if (task.ring_sizes != nullptr) keep_corner(task, first, step, on, corner);
    last_x = choose(on, corner.x, last_x);
    last_y = choose(on, corner.y, last_y);
    on = turn(arms, corner, on & bounded, ax, ay);
  }
  twice_area = twice_area + (last_x * first_y - last_y * first_x);
  double areas[lanes], squares[lanes];
  store(areas, all(0.5) * twice_area);
  store(squares, choose(bounded & ~on, farthest, all(infinity)));
  for (int lane = 0; lane < lanes && first + lane < task.count; ++lane) {
    task.areas[first + lane] = areas[lane];
    task.farthest_squared[first + lane] = squares[lane];
  }
}

}  // namespace

void find_cell_rings(const RingTask& task) {
  Arms arms{};
  for (int first = 0; first < task.count; first += lanes) {
    gather(task, first, arms);
    walk_around(task, first, arms);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
