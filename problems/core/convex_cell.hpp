#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "methods/core/points.hpp"
#include "problems/core/simd/cut_cells.hpp"

namespace strongpoint {

/// What a half-space did to a cell.
enum class Clip { untouched, cut, emptied };

/// Label of the faces of the box that a cell starts as, and of planes that are given none.
inline constexpr int unlabelled = -1;

/// A bounded convex cell that starts as a box and is cut by half-spaces; every face keeps the label
/// of the half-space that made it. Give coordinates relative to a point in or near the cell:
/// vertices within 1e-14 of the box's size of a plane count as lying on it. After the first few
/// cuts no memory is allocated.
template <int Dim>
class ConvexCell;

/// An interval.
template <>
class ConvexCell<1> {
 public:
  /// Starts over with the box between two corners.
  void reset(const Point<1>& low, const Point<1>& high);
  /// Keeps {x: normal.x <= offset}.
  Clip clip(const Point<1>& normal, double offset, int label = unlabelled);
  /// Length, 0 when empty.
  double measure() const;
  /// Its ends, none when empty.
  const std::vector<Point<1>>& vertices() const { return ends_; }
  /// Label of what made an end: 0 the low one, 1 the high one.
  int label(int end) const { return labels_[end]; }

 private:
  std::vector<Point<1>> ends_;  ///< low, high
  std::array<int, 2> labels_{unlabelled, unlabelled};
  double tolerance_ = 0;
};

/// A polygon, cut by the algorithm of Sutherland and Hodgman.
template <>
class ConvexCell<2> {
 public:
  /// Starts over with the box between two corners.
  void reset(const Point<2>& low, const Point<2>& high);
  /// Keeps {x: normal.x <= offset}; the normal has unit length.
  Clip clip(const Point<2>& normal, double offset, int label = unlabelled);
  /// Area, 0 when empty.
  double measure() const;
  /// Its corners, counter-clockwise, none when empty.
  const std::vector<Point<2>>& vertices() const { return corners_; }
  /// Label of what made the edge from a corner to the next.
  int label(int corner) const { return labels_[corner]; }

 private:
  std::vector<Point<2>> corners_, next_corners_;
  std::vector<int> labels_, next_labels_;  ///< of the edge that begins at each corner
  std::vector<double> height_;             ///< of each corner above the plane
  double tolerance_ = 0;

  void keep(const Point<2>& corner, int label);
};

/// A polyhedron, kept as loops of vertices around its faces.
template <>
class ConvexCell<3> {
 public:
  /// Starts over with the box between two corners.
  void reset(const Point<3>& low, const Point<3>& high);
  /// Takes over a cell that was cut elsewhere.
  void assign(const CutCell& cell);
  /// Keeps {x: normal.x <= offset}; the normal has unit length.
  Clip clip(const Point<3>& normal, double offset, int label = unlabelled);
  /// Volume, 0 when empty.
  double measure() const;
  /// Its vertices in no particular order, none when empty; an almost flat corner may hold a few
  /// twice.
  const std::vector<Point<3>>& vertices() const { return vertices_; }
  /// Number of faces, 0 when empty.
  int face_count() const { return faces_.size(); }
  /// Vertices around a face, counter-clockwise seen from outside.
  std::span<const int> face(int i) const {
    return {faces_.loop.data() + faces_.start[i], faces_.loop.data() + faces_.start[i + 1]};
  }
  /// Label of what made a face.
  int label(int face) const { return faces_.label[face]; }

 private:
  /// Faces as loops of vertices, counter-clockwise seen from outside.
  struct Faces {
    std::vector<int> start{0};  ///< (faces + 1) into `loop`
    std::vector<int> loop;
    std::vector<int> label;  ///< (faces)

    int size() const { return static_cast<int>(start.size()) - 1; }
    void clear();
    void append(int vertex);    ///< to the open loop, unless it ends with this vertex
    void close(int its_label);  ///< the open loop, or drops it when it is no polygon
  };
  /// A vertex made where an edge meets the plane.
  struct CutEdge {
    int inside, outside;  ///< vertices before the cut
    int vertex;           ///< after it
  };

  std::vector<Point<3>> vertices_, next_vertices_;
  Faces faces_, next_faces_;
  std::vector<double> height_;   ///< of each vertex above the plane
  std::vector<int> renumbered_;  ///< id after the cut, -1 for vertices that are cut off
  std::vector<CutEdge> cut_edges_;
  std::vector<int> rim_;                            ///< vertices of the new face
  std::vector<std::pair<double, int>> rim_angles_;  ///< the same with their position around it
  double tolerance_ = 0;

  void keep_vertices_inside();
  void cut_face(int face);
  int cut_vertex(int inside, int outside);
  void add_to_rim(int vertex);
  void add_new_face(const Point<3>& normal, int label);
};

/// Square of the largest distance of a vertex from the origin.
template <int Dim>
double farthest_squared(const ConvexCell<Dim>& cell) {
  double farthest = 0;
  for (const Point<Dim>& v : cell.vertices()) farthest = std::max(farthest, v.squaredNorm());
  return farthest;
}

}  // namespace strongpoint
