#pragma once

// For kernel sources only (methods/core/simd/path.hpp): rays inside Voronoi cells, one a lane.

#include <cstdint>

#include "problems/core/simd/nearest_crossing.hpp"
#include "problems/core/simd/walk_cells.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

inline constexpr double infinity = __builtin_inf();

/// Neighbours that are looked at before asking which others can matter, and then at a time.
inline constexpr int first_look = 24;
inline constexpr int next_look = 8;

/// More than the round-off of a squared distance.
inline constexpr double slack = 1 + 1e-12;

/// A vector in space.
struct Vector {
  double x, y, z;
};

inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double a, Vector b) { return {a * b.x, a * b.y, a * b.z}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The half-spaces arm.x <= half between a node and its neighbours by distance, a node a lane; arms
/// of zeros, which no ray crosses, for the node itself.
struct Bisectors {
  /// Those in one place of all lists: normals and offsets.
  struct Planes {
    Pack x, y, z, half;
  };
  Planes planes[most_walk_neighbours];
  /// A bit a lane whose ray may cross it.
  unsigned char allowed[most_walk_neighbours];

  /// The normal of one lane.
  Vector arm(int place, int lane) const {
    const auto* const numbers = reinterpret_cast<const double*>(planes + place);
    return {numbers[lane], numbers[lanes + lane], numbers[2 * lanes + lane]};
  }
};

/// An edge that leaves a vertex between two faces, with the third face of the vertex.
struct Edge {
  unsigned char vertex, right, left, third;
};

/// Rays inside the cells, a lane each.
struct Rays {
  double x[lanes], y[lanes], z[lanes];
  double along_x[lanes], along_y[lanes], along_z[lanes];
  Edge edges[lanes];  ///< that they follow; faces of 0 (the node itself) for none
  double t[lanes];    ///< to the first bisector; infinite where they cross none
  double place[lanes];
};

/// Rays as packs.
struct Bundle {
  Pack x, y, z, along_x, along_y, along_z;
};

/// Looks at one bisector.
inline void look(const Bisectors& bisectors, const Bundle& rays, int j, Pack place,
                 Nearest& nearest) {
  const Bisectors::Planes& plane = bisectors.planes[j];
  const Pack above = plane.half - (plane.x * rays.x + plane.y * rays.y + plane.z * rays.z);
  const Pack below = plane.x * rays.along_x + plane.y * rays.along_y + plane.z * rays.along_z;
  const Pack allowed = choose(bisectors.allowed[j], above, all(infinity));
  compare(choose_less(all(0), below, allowed, all(infinity)), below, place, nearest);
}

/// Follows the rays to the first bisectors that they leave their cells through.
inline void follow(const Bisectors& bisectors, int size, unsigned on, Rays& lanes_of_rays) {
  const Bundle rays{load(lanes_of_rays.x),       load(lanes_of_rays.y),
                    load(lanes_of_rays.z),       load(lanes_of_rays.along_x),
                    load(lanes_of_rays.along_y), load(lanes_of_rays.along_z)};
  const Pack from_squared = rays.x * rays.x + rays.y * rays.y + rays.z * rays.z;
  // Two of them: each waits for itself only.
  Nearest nearest{all(infinity), all(1), all(0)}, odd = nearest;
  Pack t = all(infinity), place = all(0);
  for (int j = 0, end = first_look; j < size; end += next_look) {
    end = end < size ? end : size;
    for (; j + 1 < end; j += 2) {
      look(bisectors, rays, j, place, nearest);
      look(bisectors, rays, j + 1, place + all(1), odd);
      place = place + all(2);
    }
    if (j < end) look(bisectors, rays, j++, place, nearest);
    compare(odd.above, odd.below, odd.place, nearest);
    t = nearest.above / nearest.below;
    // A bisector that passes between the ends of a ray is at most as far away as the farther one.
    const Pack x = rays.x + t * rays.along_x;
    const Pack y = rays.y + t * rays.along_y;
    const Pack z = rays.z + t * rays.along_z;
    const Pack square = choose_less(t, all(infinity), x * x + y * y + z * z, all(infinity));
    const Pack limit = all(2 * slack) * max(from_squared, square);
    if (j < size && (less(bisectors.planes[j].half, limit) & on) == 0) break;
  }
  store(lanes_of_rays.t, t);
  store(lanes_of_rays.place, nearest.place);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
