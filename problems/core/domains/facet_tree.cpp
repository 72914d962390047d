#include "problems/core/domains/facet_tree.hpp"

#include <algorithm>
#include <limits>

namespace strongpoint {
namespace {

constexpr int leaf_size = 4;

/// Weights of the point of a segment nearest to x.
std::array<double, 2> nearest_on(const Points<2>& vertices, const std::array<int, 2>& corners,
                                 const Point<2>& x) {
  const Point<2> a = vertices.col(corners[0]);
  const Point<2> along = vertices.col(corners[1]) - a;
  const double t = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return {1 - t, t};
}

/// Weights of the point of a triangle nearest to x. Source: Ericson 2005, Real-time collision
/// detection, 5.1.5.
std::array<double, 3> nearest_on(const Points<3>& vertices, const std::array<int, 3>& corners,
                                 const Point<3>& x) {
  const Point<3> a = vertices.col(corners[0]);
  const Point<3> b = vertices.col(corners[1]);
  const Point<3> c = vertices.col(corners[2]);
  const Point<3> ab = b - a;
  const Point<3> ac = c - a;
  const double d1 = ab.dot(x - a);
  const double d2 = ac.dot(x - a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = ab.dot(x - b);
  const double d4 = ac.dot(x - b);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = d1 / (d1 - d3);
    return {1 - t, t, 0};
  }
  const double d5 = ab.dot(x - c);
  const double d6 = ac.dot(x - c);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d2 / (d2 - d6);
    return {1 - t, 0, t};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

template <int Dim>
FacetTree<Dim>::FacetTree(const BoundaryMesh<Dim>& mesh, std::vector<int> facets)
    : mesh_(mesh), facets_(std::move(facets)) {
  build(0, static_cast<int>(facets_.size()));
}

template <int Dim>
void FacetTree<Dim>::build(int first, int last) {
  const auto id = static_cast<int>(boxes_.size());
  Point<Dim> low = Point<Dim>::Constant(std::numeric_limits<double>::infinity());
  Point<Dim> high = -low;
  for (int i = first; i < last; ++i) {
    for (int corner : mesh_.facets[facets_[i]].corners) {
      low = low.cwiseMin(mesh_.vertices.col(corner));
      high = high.cwiseMax(mesh_.vertices.col(corner));
    }
  }
  boxes_.push_back({low, high, first, last});
  if (last - first <= leaf_size) return;
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const auto position = [&](int facet) {  // of the sum of its corners
    double sum = 0;
    for (int corner : mesh_.facets[facet].corners) sum += mesh_.vertices(axis, corner);
    return sum;
  };
  const int middle = (first + last) / 2;
  std::nth_element(facets_.begin() + first, facets_.begin() + middle, facets_.begin() + last,
                   [&](int a, int b) {
                     const double left = position(a);
                     const double right = position(b);
                     return left < right || (left == right && a < b);
                   });
  build(first, middle);
  boxes_[id].right = static_cast<int>(boxes_.size());
  build(middle, last);
}

template <int Dim>
NearestPlace<Dim> FacetTree<Dim>::nearest(const Point<Dim>& x) const {
  NearestPlace<Dim> best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  search(0, x, best);
  return best;
}

template <int Dim>
void FacetTree<Dim>::search(int box, const Point<Dim>& x, NearestPlace<Dim>& best) const {
  const Box& here = boxes_[box];
  if (here.right < 0) {
    for (int i = here.first; i < here.last; ++i) {
      const std::array<int, Dim>& corners = mesh_.facets[facets_[i]].corners;
      const std::array<double, Dim> weights = nearest_on(mesh_.vertices, corners, x);
      Point<Dim> offset = -x;
      for (int j = 0; j < Dim; ++j) offset += weights[j] * mesh_.vertices.col(corners[j]);
      const double squared = offset.squaredNorm();
      if (squared < best.squared_distance) best = {facets_[i], weights, squared};
    }
    return;
  }
  const auto squared_to = [&](const Box& other) {
    return (other.low - x).cwiseMax(x - other.high).cwiseMax(0).squaredNorm();
  };
  std::array<int, 2> children{box + 1, here.right};
  std::array<double, 2> squared{squared_to(boxes_[children[0]]), squared_to(boxes_[children[1]])};
  if (squared[1] < squared[0]) {
    std::swap(children[0], children[1]);
    std::swap(squared[0], squared[1]);
  }
  for (int i = 0; i < 2; ++i) {
    if (squared[i] < best.squared_distance) search(children[i], x, best);
  }
}

template class FacetTree<2>;
template class FacetTree<3>;

}  // namespace strongpoint
