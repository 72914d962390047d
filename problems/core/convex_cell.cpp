#include "problems/core/convex_cell.hpp"

#include <cstddef>

#include <Eigen/Geometry>

namespace strongpoint {
namespace {

/// Heights within this fraction of the box's size are round-off: such vertices lie on the plane.
constexpr double relative_tolerance = 1e-14;

/// Where the edge from `inside` to `outside` meets the plane, given the heights of its ends.
template <int Dim>
Point<Dim> crossing(const Point<Dim>& inside, double height_inside, const Point<Dim>& outside,
                    double height_outside) {
  const double t = height_inside / (height_inside - height_outside);
  return inside + std::clamp(t, 0.0, 1.0) * (outside - inside);
}

/// Fills `heights` and says what the plane will do to the vertices.
template <int Dim>
Clip classify(const std::vector<Point<Dim>>& vertices, const Point<Dim>& normal, double offset,
              double tolerance, std::vector<double>& heights) {
  heights.clear();
  std::size_t outside = 0;
  for (const Point<Dim>& v : vertices) {
    heights.push_back(normal.dot(v) - offset);
    // Written so that a plane of NaNs empties the cell, which callers report.
    if (!(heights.back() <= tolerance)) ++outside;
  }
  if (outside == vertices.size()) return Clip::emptied;
  return outside == 0 ? Clip::untouched : Clip::cut;
}

}  // namespace

void ConvexCell<1>::reset(const Point<1>& low, const Point<1>& high) {
  ends_.assign({low, high});
  labels_ = {unlabelled, unlabelled};
  tolerance_ = relative_tolerance * (high[0] - low[0]);
}

Clip ConvexCell<1>::clip(const Point<1>& normal, double offset, int label) {
  if (ends_.empty()) return Clip::emptied;
  const double low = normal[0] * ends_[0][0] - offset;
  const double high = normal[0] * ends_[1][0] - offset;
  if (low <= tolerance_ && high <= tolerance_) return Clip::untouched;
  if (!(low <= tolerance_) && !(high <= tolerance_)) {
    ends_.clear();
    return Clip::emptied;
  }
  const std::size_t end = low > high ? 0 : 1;
  ends_[end][0] = offset / normal[0];
  labels_[end] = label;
  return Clip::cut;
}

double ConvexCell<1>::measure() const { return ends_.empty() ? 0 : ends_[1][0] - ends_[0][0]; }

void ConvexCell<2>::reset(const Point<2>& low, const Point<2>& high) {
  corners_.assign({low, {high[0], low[1]}, high, {low[0], high[1]}});
  labels_.assign(4, unlabelled);
  tolerance_ = relative_tolerance * (high - low).maxCoeff();
}

void ConvexCell<2>::keep(const Point<2>& corner, int label) {
  next_corners_.push_back(corner);
  next_labels_.push_back(label);
}

Clip ConvexCell<2>::clip(const Point<2>& normal, double offset, int label) {
  const Clip outcome = classify<2>(corners_, normal, offset, tolerance_, height_);
  if (outcome == Clip::emptied) {
    corners_.clear();
    labels_.clear();
  }
  if (outcome != Clip::cut) return outcome;
  next_corners_.clear();
  next_labels_.clear();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const std::size_t j = i + 1 == corners_.size() ? 0 : i + 1;
    const bool inside_i = height_[i] <= tolerance_;
    const bool inside_j = height_[j] <= tolerance_;
    // An edge whose inner end lies on the plane already ends there.
    const bool leaves_at_i = inside_i && !inside_j && height_[i] >= -tolerance_;
    if (inside_i) keep(corners_[i], leaves_at_i ? label : labels_[i]);
    if (inside_i && !inside_j && !leaves_at_i) {
      keep(crossing<2>(corners_[i], height_[i], corners_[j], height_[j]), label);
    }
    if (!inside_i && inside_j && height_[j] < -tolerance_) {
      keep(crossing<2>(corners_[j], height_[j], corners_[i], height_[i]), labels_[i]);
    }
  }
  corners_.swap(next_corners_);
  labels_.swap(next_labels_);
  return Clip::cut;
}

double ConvexCell<2>::measure() const {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < corners_.size(); ++i) {
    const Point<2> a = corners_[i] - corners_[0];
    const Point<2> b = corners_[i + 1] - corners_[0];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

void ConvexCell<3>::Faces::clear() {
  start.assign(1, 0);
  loop.clear();
  label.clear();
}

void ConvexCell<3>::Faces::append(int vertex) {
  if (static_cast<int>(loop.size()) > start.back() && loop.back() == vertex) return;
  loop.push_back(vertex);
}

void ConvexCell<3>::Faces::close(int its_label) {
  const auto first = static_cast<std::size_t>(start.back());
  if (loop.size() > first + 1 && loop.back() == loop[first]) loop.pop_back();
  if (loop.size() < first + 3) {
    loop.resize(first);
  } else {
    start.push_back(static_cast<int>(loop.size()));
    label.push_back(its_label);
  }
}

void ConvexCell<3>::reset(const Point<3>& low, const Point<3>& high) {
  vertices_.clear();
  for (int corner = 0; corner < 8; ++corner) {
    vertices_.push_back({corner & 4 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                         corner & 1 ? high[2] : low[2]});
  }
  faces_.start.assign({0, 4, 8, 12, 16, 20, 24});
  faces_.loop.assign({0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3});
  faces_.label.assign(6, unlabelled);
  tolerance_ = relative_tolerance * (high - low).maxCoeff();
}

void ConvexCell<3>::assign(const CutCell& cell) {
  vertices_.clear();
  for (int v = 0; v < cell.vertices; ++v) vertices_.push_back({cell.x[v], cell.y[v], cell.z[v]});
  faces_.clear();
  std::array<char, 4 * CutCell::most_vertices> is_done{};
  for (int first = 0; first < 4 * cell.vertices; ++first) {
    if (is_done[first] != 0 || (first & 3) == 3) continue;
    int edge = first;
    do {
      is_done[edge] = 1;
      faces_.append(edge / 4);
      const int other = cell.twin[edge];
      edge = (other & 3) == 0 ? other + 2 : other - 1;  // the next one around the face to the left
    } while (edge != first);
    faces_.close(cell.label[cell.face[first]]);
  }
  tolerance_ = cell.tolerance;
}

Clip ConvexCell<3>::clip(const Point<3>& normal, double offset, int label) {
  const Clip outcome = classify<3>(vertices_, normal, offset, tolerance_, height_);
  if (outcome == Clip::emptied) {
    vertices_.clear();
    faces_.clear();
  }
  if (outcome != Clip::cut) return outcome;
  keep_vertices_inside();
  next_faces_.clear();
  for (int face = 0; face < faces_.size(); ++face) cut_face(face);
  add_new_face(normal, label);
  vertices_.swap(next_vertices_);
  std::swap(faces_, next_faces_);
  return Clip::cut;
}

void ConvexCell<3>::keep_vertices_inside() {
  next_vertices_.clear();
  renumbered_.clear();
  cut_edges_.clear();
  rim_.clear();
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (height_[v] <= tolerance_) {
      renumbered_.push_back(static_cast<int>(next_vertices_.size()));
      next_vertices_.push_back(vertices_[v]);
    } else {
      renumbered_.push_back(-1);
    }
  }
}

void ConvexCell<3>::cut_face(int face) {
  const int first = faces_.start[face];
  const int end = faces_.start[face + 1];
  for (int i = first; i < end; ++i) {
    const int a = faces_.loop[i];
    const int b = faces_.loop[i + 1 == end ? first : i + 1];
    const bool inside_a = renumbered_[a] >= 0;
    const bool inside_b = renumbered_[b] >= 0;
    if (inside_a) next_faces_.append(renumbered_[a]);
    if (inside_a != inside_b) next_faces_.append(inside_a ? cut_vertex(a, b) : cut_vertex(b, a));
  }
  next_faces_.close(faces_.label[face]);
}

int ConvexCell<3>::cut_vertex(int inside, int outside) {
  // An edge whose inner end lies on the plane is cut there, which keeps planes through a vertex
  // from multiplying it.
  if (height_[inside] >= -tolerance_) {
    add_to_rim(renumbered_[inside]);
    return renumbered_[inside];
  }
  for (const CutEdge& cut : cut_edges_) {
    if (cut.inside == inside && cut.outside == outside) return cut.vertex;
  }
  const int vertex = static_cast<int>(next_vertices_.size());
  next_vertices_.push_back(
      crossing<3>(vertices_[inside], height_[inside], vertices_[outside], height_[outside]));
  cut_edges_.push_back({inside, outside, vertex});
  rim_.push_back(vertex);
  return vertex;
}

void ConvexCell<3>::add_to_rim(int vertex) {
  if (std::find(rim_.begin(), rim_.end(), vertex) == rim_.end()) rim_.push_back(vertex);
}

void ConvexCell<3>::add_new_face(const Point<3>& normal, int label) {
  // The rim is sorted by angle instead of being chained along the cut faces: round-off can break
  // the chain where faces are almost parallel to the plane, but never the order by more than
  // round-off.
  if (rim_.size() < 3) return;
  Point<3> middle = Point<3>::Zero();
  for (int v : rim_) middle += next_vertices_[v];
  middle /= static_cast<double>(rim_.size());
  const Point<3> across = normal.unitOrthogonal();
  const Point<3> up = normal.cross(across);
  rim_angles_.clear();
  for (int v : rim_) {
    const Point<3> arm = next_vertices_[v] - middle;
    rim_angles_.emplace_back(std::atan2(arm.dot(up), arm.dot(across)), v);
  }
  std::sort(rim_angles_.begin(), rim_angles_.end());
  for (const auto& [angle, v] : rim_angles_) next_faces_.append(v);
  next_faces_.close(label);
}

double ConvexCell<3>::measure() const {
  double six_times = 0;
  for (int face = 0; face < faces_.size(); ++face) {
    const Point<3> apex = vertices_[faces_.loop[faces_.start[face]]] - vertices_[0];
    for (int i = faces_.start[face] + 1; i + 1 < faces_.start[face + 1]; ++i) {
      const Point<3> a = vertices_[faces_.loop[i]] - vertices_[0];
      const Point<3> b = vertices_[faces_.loop[i + 1]] - vertices_[0];
      six_times += apex.dot(a.cross(b));
    }
  }
  return six_times / 6;
}

}  // namespace strongpoint
