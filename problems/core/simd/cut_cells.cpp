#include "problems/core/simd/cut_cells.hpp"

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Heights within this fraction of the cube's size are round-off: such vertices lie on the plane.
constexpr double relative_tolerance = 1e-14;

/// Edges that a plane may cross.
constexpr int most_crossings = 64;

/// The half-space normal.x <= offset; the normal need not have unit length.
struct Plane {
  double x, y, z, offset;
  double tolerance;  ///< for heights in units of the normal
};

/// The vertices above a plane.
struct Outside {
  int count;
  int vertex[CutCell::most_vertices];             ///< ascending
  unsigned bits[CutCell::most_vertices / lanes];  ///< of packs of vertices

  /// 1 for a vertex above, 0 for one below.
  unsigned holds(int v) const { return bits[v / lanes] >> v % lanes & 1U; }
};

/// The edges that cross a plane, from above, and the new vertices on them.
struct Rim {
  int count;
  int outer[3 * CutCell::most_vertices];  ///< vertex above; the last entries are overwritten
  int inner[3 * CutCell::most_vertices];  ///< edge as it leaves the vertex below
  int left[3 * CutCell::most_vertices];   ///< face to the left, seen from above
  int place[most_crossings];              ///< of the new vertex
  int next[most_crossings];  ///< the crossing before it on the face to the left: goes around the
                             ///< rim
  double x[most_crossings], y[most_crossings], z[most_crossings];
};

/// Starts over with the cube of a half width. Slots 0, 1, 2 of a corner are its edges along x, y, z
/// where an even number of its coordinates are low, and along x, z, y elsewhere.
void reset(CutCell& cell, double half) {
  for (int v = 8; v < cell.vertices; ++v) {
    cell.x[v] = cell.y[v] = cell.z[v] = cell.squared[v] = 0;
  }
  cell.vertices = 8;
  cell.faces = 6;
  cell.tolerance = relative_tolerance * 2 * half;
  for (int v = 0; v < 8; ++v) {
    const int high[3] = {v >> 2 & 1, v >> 1 & 1, v & 1};
    cell.x[v] = high[0] != 0 ? half : -half;
    cell.y[v] = high[1] != 0 ? half : -half;
    cell.z[v] = high[2] != 0 ? half : -half;
    cell.squared[v] = 3 * half * half;
    const bool even = (high[0] + high[1] + high[2]) % 2 == 1;
    const int axis[3] = {0, even ? 1 : 2, even ? 2 : 1};
    for (int s = 0; s < 3; ++s) {
      const int other = v ^ 4 >> axis[s];
      cell.twin[4 * v + s] = static_cast<unsigned short>(4 * other + (s == 0 ? 0 : 3 - s));
      const int across = axis[s == 0 ? 2 : s - 1];  // the face holds edges s and s + 1
      cell.face[4 * v + s] = static_cast<unsigned char>(2 * across + high[across]);
    }
  }
  for (int f = 0; f < 6; ++f) {
    for (int c = 0; c < 3; ++c) cell.foot[f][c] = f / 2 != c ? 0 : f % 2 == 0 ? -half : half;
    cell.label[f] = -1;
  }
}

/// Fills the heights and lists the vertices above the plane.
void classify(CutCell& cell, const Plane& plane, Outside& outside) {
  const Pack x = all(plane.x), y = all(plane.y), z = all(plane.z);
  const Pack offset = all(plane.offset);
  const Pack tolerance = all(plane.tolerance);
  unsigned any = 0;
  for (int first = 0, p = 0; first < cell.vertices; first += lanes, ++p) {
    const Pack height =
        x * load(cell.x + first) + y * load(cell.y + first) + (z * load(cell.z + first) - offset);
    store(cell.height + first, height);
    outside.bits[p] = less(tolerance, height);
    any |= outside.bits[p];
  }
  outside.count = 0;
  if (any == 0) return;
  for (int first = 0, p = 0; first < cell.vertices; first += lanes, ++p) {
    for (unsigned bits = outside.bits[p]; bits != 0; bits &= bits - 1) {
      outside.vertex[outside.count++] = first + __builtin_ctz(bits);
    }
  }
}

/// Finds the edges that cross the plane, without branches that depend on the shape.
void find_crossings(CutCell& cell, const Outside& outside, Rim& rim) {
  int count = 0;
  for (int i = 0; i < outside.count; ++i) {
    const int outer = outside.vertex[i];
    for (int edge = 4 * outer; edge < 4 * outer + 3; ++edge) {
      const int inner = cell.twin[edge];
      const bool crosses = outside.holds(inner >> 2) == 0;
      rim.outer[count] = outer;
      rim.inner[count] = inner;
      rim.left[count] = cell.face[edge];
      cell.crossing[crosses ? cell.face[inner] : CutCell::most_faces] =
          static_cast<unsigned char>(count);
      count += static_cast<int>(crosses);
    }
  }
  rim.count = count;
}

/// Puts vertices where edges cross the plane, in the places of those that go, then at the end.
/// False unless each face that is crossed is entered and left once.
bool place_rim(const CutCell& cell, const Outside& outside, Rim& rim) {
  bool is_sound = true;
  std::uint64_t entered = 0;
  for (int i = 0; i < rim.count; ++i) {
    const int next = cell.crossing[rim.left[i]] % most_crossings;
    is_sound = is_sound && next < rim.count && cell.face[rim.inner[next]] == rim.left[i];
    entered |= std::uint64_t{1} << next;
    rim.next[i] = next;
    rim.place[i] = i < outside.count ? outside.vertex[i] : cell.vertices + i - outside.count;
    const int a = rim.inner[i] >> 2;
    const int b = rim.outer[i];
    const double height = cell.height[a];
    const double t = height < 0 ? height / (height - cell.height[b]) : 0;
    rim.x[i] = cell.x[a] + t * (cell.x[b] - cell.x[a]);
    rim.y[i] = cell.y[a] + t * (cell.y[b] - cell.y[a]);
    rim.z[i] = cell.z[a] + t * (cell.z[b] - cell.z[a]);
  }
  return is_sound && entered == ~std::uint64_t{0} >> (most_crossings - rim.count);
}

/// Moves a vertex to a free place.
void move_vertex(CutCell& cell, int from, int to) {
  cell.x[to] = cell.x[from];
  cell.y[to] = cell.y[from];
  cell.z[to] = cell.z[from];
  cell.squared[to] = cell.squared[from];
  for (int s = 0; s < 3; ++s) {
    const unsigned short other = cell.twin[4 * from + s];
    cell.twin[4 * to + s] = other;
    cell.twin[other] = static_cast<unsigned short>(4 * to + s);
    cell.face[4 * to + s] = cell.face[4 * from + s];
  }
}

/// Puts in the new vertices, joins them around the new face, and closes the gaps.
void join_rim(CutCell& cell, const Outside& outside, const Rim& rim) {
  const auto new_face = static_cast<unsigned char>(cell.faces - 1);
  for (int i = 0; i < rim.count; ++i) {
    const int v = rim.place[i];
    cell.x[v] = rim.x[i];
    cell.y[v] = rim.y[i];
    cell.z[v] = rim.z[i];
    cell.squared[v] = rim.x[i] * rim.x[i] + rim.y[i] * rim.y[i] + rim.z[i] * rim.z[i];
    cell.twin[4 * v] = static_cast<unsigned short>(rim.inner[i]);
    cell.twin[rim.inner[i]] = static_cast<unsigned short>(4 * v);
    cell.face[4 * v] = static_cast<unsigned char>(rim.left[i]);
    cell.face[4 * v + 1] = new_face;
    const int to = rim.place[rim.next[i]];
    cell.twin[4 * v + 1] = static_cast<unsigned short>(4 * to + 2);
    cell.twin[4 * to + 2] = static_cast<unsigned short>(4 * v + 1);
    cell.face[4 * to + 2] = static_cast<unsigned char>(rim.left[i]);
  }
  if (rim.count >= outside.count) {
    cell.vertices += rim.count - outside.count;
    return;
  }
  for (int i = outside.count - 1; i >= rim.count; --i) {
    const int last = --cell.vertices;
    // The analyser does not see that `classify` filled the list.
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult)
    if (outside.vertex[i] != last) move_vertex(cell, last, outside.vertex[i]);
    cell.x[last] = cell.y[last] = cell.z[last] = cell.squared[last] = 0;
  }
}

/// What a plane did to a cell.
enum class Outcome { untouched, cut, broken };

Outcome cut(CutCell& cell, const Plane& plane, int label) {
  Outside outside;
  classify(cell, plane, outside);
  if (outside.count == 0) return Outcome::untouched;
  Rim rim;
  find_crossings(cell, outside, rim);
  if (rim.count < 3 || rim.count > most_crossings || cell.faces == CutCell::most_faces ||
      cell.vertices + rim.count - outside.count > CutCell::most_vertices ||
      !place_rim(cell, outside, rim)) {
    return Outcome::broken;
  }
  const double square = plane.x * plane.x + plane.y * plane.y + plane.z * plane.z;
  double* const foot = cell.foot[cell.faces];
  foot[0] = plane.offset / square * plane.x;
  foot[1] = plane.offset / square * plane.y;
  foot[2] = plane.offset / square * plane.z;
  cell.label[cell.faces] = label;
  ++cell.faces;
  join_rim(cell, outside, rim);
  return Outcome::cut;
}

double farthest_squared(const CutCell& cell) {
  Pack farthest = all(0);
  for (int v = 0; v < cell.vertices; v += lanes) farthest = max(farthest, load(cell.squared + v));
  double squares[lanes];
  store(squares, farthest);
  double largest = squares[0];
  for (int lane = 1; lane < lanes; ++lane) {
    largest = squares[lane] > largest ? squares[lane] : largest;
  }
  return largest;
}

/// Volume by pyramids from the origin: a sixth of foot.(a x b) over the edges ab of all faces.
double volume(const CutCell& cell) {
  double six_times = 0;
  for (int a = 0; a < cell.vertices; ++a) {
    double x = 0, y = 0, z = 0;
    for (int s = 0; s < 3; ++s) {
      const int b = cell.twin[4 * a + s] >> 2;
      const double* const foot = cell.foot[cell.face[4 * a + s]];
      x += cell.y[b] * foot[2] - cell.z[b] * foot[1];
      y += cell.z[b] * foot[0] - cell.x[b] * foot[2];
      z += cell.x[b] * foot[1] - cell.y[b] * foot[0];
    }
    six_times += cell.x[a] * x + cell.y[a] * y + cell.z[a] * z;
  }
  return six_times / 6;
}

/// Cuts the cell of one node; false where it breaks.
bool cut_cell(const CutTask& task, int row, CutCell& cell) {
  reset(cell, task.half_widths[row]);
  for (int i = 0; i < task.plane_count; ++i) {
    const double* const normal = task.planes[i].normal;
    const Plane plane{normal[0], normal[1], normal[2], 0, cell.tolerance};
    if (cut(cell, plane, task.planes[i].label) == Outcome::broken) return false;
  }
  const double* const node = task.nodes + 3 * static_cast<long>(task.chosen[row]);
  double security = 4 * farthest_squared(cell);
  bool is_smaller = false;  // than `security` says
  for (std::int64_t i = task.offsets[row]; i < task.offsets[row + 1]; ++i) {
    if (task.ids[i] == task.chosen[row]) continue;
    const double* const other = task.nodes + 3 * static_cast<long>(task.ids[i]);
    Plane plane{other[0] - node[0], other[1] - node[1], other[2] - node[2], 0, 0};
    const double square = plane.x * plane.x + plane.y * plane.y + plane.z * plane.z;
    if (square > security) return true;
    if (!(square > 0)) return false;
    plane.offset = square / 2;
    plane.tolerance = cell.tolerance * __builtin_sqrt(square);
    const Outcome outcome = cut(cell, plane, task.ids[i]);
    if (outcome == Outcome::broken) return false;
    if (is_smaller && outcome == Outcome::untouched) security = 4 * farthest_squared(cell);
    is_smaller = outcome == Outcome::cut;
  }
  return true;
}

}  // namespace

void cut_cells(const CutTask& task) {
  for (int row = 0; row < task.count; ++row) {
    CutCell& cell = *task.work;
    const bool is_whole = cut_cell(task, row, cell);
    task.states[row] = is_whole ? CutState::whole : CutState::broken;
    if (task.volumes != nullptr) task.volumes[row] = is_whole ? volume(cell) : 0;
    task.farthest_squared[row] = is_whole ? farthest_squared(cell) : __builtin_inf();
  }
}

void cut_further(const FurtherCut& task) {
  const double* const normal = task.plane.normal;
  const Plane plane{normal[0], normal[1], normal[2], task.offset, task.cell->tolerance};
  const bool is_broken = cut(*task.cell, plane, task.plane.label) == Outcome::broken;
  *task.state = is_broken ? CutState::broken : CutState::whole;
}

void measure_cell(const ExtentTask& task) {
  *task.volume = volume(*task.cell);
  *task.farthest_squared = farthest_squared(*task.cell);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
