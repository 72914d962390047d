#include "problems/core/simd/walk_cells.hpp"

#include "problems/core/simd/walk_rays.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Vertices of a cell with as many faces as there are neighbours, and those of a walk that goes
/// wrong.
constexpr int most_vertices = 2 * most_walk_neighbours;

/// A cell while it is made. Its faces are places in the list of neighbours; seen from outside,
/// counter-clockwise around a vertex, they own the ordered pairs that follow each other.
struct Walk {
  Vector at[most_vertices];
  unsigned char faces[most_vertices][3];
  /// Vertex that owns an ordered pair of faces, plus one; 0 for none.
  unsigned char owner[most_walk_neighbours * most_walk_neighbours];
  Edge edges[3 * most_vertices];  ///< each one once, from the vertex that was first
  int vertices, edge_count;
  int next;             ///< edge to be followed; -2 and -1 on the way to the first vertex
  std::uint64_t seen;   ///< a bit a face
  double twelve_times;  ///< the volume so far
  WalkState state;
};

/// Cells made side by side.
struct Group {
  Bisectors bisectors;
  Walk walks[lanes];
  Rays rays;
};

std::uint64_t bit(int place) { return std::uint64_t{1} << place; }

int pair_of(int a, int b) { return a * most_walk_neighbours + b; }

/// Row of the task that a lane treats; the last one is repeated where the group is not full.
int row_of(const WalkTask& task, int first, int lane) {
  return first + lane < task.count ? first + lane : task.count - 1;
}

void gather(const WalkTask& task, int first, Bisectors& bisectors) {
  const int* ids[lanes];
  const double* others[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    const int row = row_of(task, first, lane);
    ids[lane] = task.ids + task.offsets[row];
    others[lane] = task.nodes + 3 * static_cast<long>(task.chosen[row]);
  }
  Pack node[3], other[3];
  load_nodes<3>(others, node);
  for (int j = 0; j < task.size; ++j) {
    for (int lane = 0; lane < lanes; ++lane) {
      others[lane] = task.nodes + 3 * static_cast<long>(ids[lane][j]);
    }
    load_nodes<3>(others, other);
    const Pack x = other[0] - node[0];
    const Pack y = other[1] - node[1];
    const Pack z = other[2] - node[2];
    bisectors.planes[j] = {x, y, z, all(0.5) * (x * x + y * y + z * z)};
  }
}

/// Notes the owner of a pair of faces, and the edge that leaves between them unless it is known
/// from its other end.
inline void own(Walk& walk, int vertex, int right, int left, int third) {
  unsigned char& mine = walk.owner[pair_of(right, left)];
  if (mine != 0) walk.state = WalkState::broken;
  mine = static_cast<unsigned char>(vertex + 1);
  walk.edges[walk.edge_count] = {
      static_cast<unsigned char>(vertex), static_cast<unsigned char>(right),
      static_cast<unsigned char>(left), static_cast<unsigned char>(third)};
  walk.edge_count += walk.owner[pair_of(left, right)] == 0 ? 1 : 0;
}

/// Adds a vertex of three faces, counter-clockwise seen from outside.
inline void add_vertex(Walk& walk, Vector at, int a, int b, int c) {
  const int vertex = walk.vertices++;
  walk.at[vertex] = at;
  walk.faces[vertex][0] = static_cast<unsigned char>(a);
  walk.faces[vertex][1] = static_cast<unsigned char>(b);
  walk.faces[vertex][2] = static_cast<unsigned char>(c);
  walk.seen |= bit(a) | bit(b) | bit(c);
  own(walk, vertex, a, b, c);
  own(walk, vertex, b, c, a);
  own(walk, vertex, c, a, b);
}

/// Gives a lane's ray something to follow.
inline void send(Group& group, int lane, Vector from, Vector along, const Edge& edge) {
  Rays& rays = group.rays;
  rays.x[lane] = from.x;
  rays.y[lane] = from.y;
  rays.z[lane] = from.z;
  rays.along_x[lane] = along.x;
  rays.along_y[lane] = along.y;
  rays.along_z[lane] = along.z;
  rays.edges[lane] = edge;
  const auto others = static_cast<unsigned char>(~(1U << lane));
  group.bisectors.allowed[edge.right] &= others;
  group.bisectors.allowed[edge.left] &= others;
  group.bisectors.allowed[edge.third] &= others;
}

/// Sends the first ray: the middle between the node and its nearest one lies on a face, from which
/// any way on it leads to an edge.
void begin(Group& group, int lane) {
  const Vector arm = group.bisectors.arm(1, lane);
  // Across the axis that the arm is farthest from lying on.
  const double x = __builtin_fabs(arm.x), y = __builtin_fabs(arm.y), z = __builtin_fabs(arm.z);
  const Vector axis = x <= y && x <= z ? Vector{1, 0, 0}
                      : y <= z         ? Vector{0, 1, 0}
                                       : Vector{0, 0, 1};
  send(group, lane, 0.5 * arm, cross(arm, axis), {0, 1, 0, 0});
}

/// Adds the pyramids from the node over triangles in the two faces of an edge: half the arm is the
/// foot of a face.
inline void add_volume(Group& group, int lane, const Edge& edge, int end) {
  Walk& walk = group.walks[lane];
  const Vector difference =
      group.bisectors.arm(edge.left, lane) - group.bisectors.arm(edge.right, lane);
  walk.twelve_times += dot(difference, cross(walk.at[edge.vertex], walk.at[end]));
}

/// Sends a ray along the next edge whose other end is not known; false when there is none.
inline bool advance(Group& group, int lane) {
  Walk& walk = group.walks[lane];
  for (; walk.next < walk.edge_count; ++walk.next) {
    const Edge& edge = walk.edges[walk.next];
    const int end = walk.owner[pair_of(edge.left, edge.right)] - 1;
    if (end < 0) {
      const Vector left = group.bisectors.arm(edge.left, lane);
      const Vector right = group.bisectors.arm(edge.right, lane);
      // The difference of two arms is exact where they are nearly parallel.
      send(group, lane, walk.at[edge.vertex], cross(left, right - left), edge);
      return true;
    }
    add_volume(group, lane, edge, end);
  }
  const int faces = __builtin_popcountll(walk.seen);
  walk.state = walk.vertices == 2 * faces - 4 ? WalkState::whole : WalkState::broken;
  return false;
}

/// Takes in where a lane's ray ended and sends the next one; false when the cell is done.
inline bool take_in(Group& group, int lane) {
  Walk& walk = group.walks[lane];
  const Rays& rays = group.rays;
  const Edge edge = rays.edges[lane];
  group.bisectors.allowed[edge.right] |= static_cast<unsigned char>(1U << lane);
  group.bisectors.allowed[edge.left] |= static_cast<unsigned char>(1U << lane);
  group.bisectors.allowed[edge.third] |= static_cast<unsigned char>(1U << lane);
  const double t = rays.t[lane];
  const int place = static_cast<int>(rays.place[lane]);
  if (!(t < infinity)) {
    walk.state = WalkState::unbounded;
    return false;
  }
  const Vector at = Vector{rays.x[lane], rays.y[lane], rays.z[lane]} +
                    t * Vector{rays.along_x[lane], rays.along_y[lane], rays.along_z[lane]};
  if (walk.next == -2) {
    const Vector arm = group.bisectors.arm(1, lane);
    send(group, lane, at, cross(arm, group.bisectors.arm(place, lane) - arm),
         {0, 1, static_cast<unsigned char>(place), 0});
    ++walk.next;
    return true;
  }
  if (walk.next == -1) {
    add_vertex(walk, at, edge.right, edge.left, place);
  } else {
    if (walk.vertices == most_vertices) walk.state = WalkState::broken;
    if (walk.state == WalkState::broken) return false;
    const int end = walk.vertices;
    add_vertex(walk, at, edge.left, edge.right, place);
    add_volume(group, lane, edge, end);
  }
  ++walk.next;
  if (walk.state == WalkState::broken) return false;
  return advance(group, lane);
}

void forget(Walk& walk) {
  for (int v = 0; v < walk.vertices; ++v) {
    const int a = walk.faces[v][0], b = walk.faces[v][1], c = walk.faces[v][2];
    walk.owner[pair_of(a, b)] = walk.owner[pair_of(b, c)] = walk.owner[pair_of(c, a)] = 0;
  }
  walk.vertices = walk.edge_count = 0;
  walk.next = -2;
  walk.seen = 0;
  walk.twelve_times = 0;
  walk.state = WalkState::unbounded;
}

double farthest_squared(const Walk& walk) {
  double farthest = 0;
  for (int v = 0; v < walk.vertices; ++v) {
    const double square = dot(walk.at[v], walk.at[v]);
    farthest = farthest < square ? square : farthest;
  }
  return farthest;
}

/// Sends the first rays of a group; the lanes that have one.
unsigned begin_group(const WalkTask& task, int first, Group& group) {
  unsigned on = 0;
  for (int lane = 0; lane < lanes; ++lane) {
    forget(group.walks[lane]);
    const int row = first + lane;
    if (row >= task.count) continue;
    const double nearest = reinterpret_cast<const double*>(&group.bisectors.planes[1].half)[lane];
    if (task.ids[task.offsets[row]] != task.chosen[row] || !(nearest > 0)) {
      group.walks[lane].state = WalkState::broken;
      continue;
    }
    begin(group, lane);
    on |= 1U << lane;
  }
  return on;
}

}  // namespace

void walk_cells(const WalkTask& task) {
  Group group{};
  for (unsigned char& lanes_allowed : group.bisectors.allowed) {
    lanes_allowed = static_cast<unsigned char>(every_lane);
  }
  for (int first = 0; first < task.count; first += lanes) {
    gather(task, first, group.bisectors);
    unsigned on = begin_group(task, first, group);
    while (on != 0) {
      follow(group.bisectors, task.size, on, group.rays);
      for (unsigned rest = on; rest != 0; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        if (!take_in(group, lane)) on &= ~(1U << lane);
      }
    }
    for (int lane = 0; lane < lanes && first + lane < task.count; ++lane) {
      const Walk& walk = group.walks[lane];
      const int row = first + lane;
      task.states[row] = walk.state;
      task.volumes[row] = walk.twelve_times / 12;
      task.farthest_squared[row] =
          walk.state == WalkState::whole ? farthest_squared(walk) : infinity;
    }
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
