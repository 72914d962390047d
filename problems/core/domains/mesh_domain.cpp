#include "problems/core/domains/mesh_domain.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// A weight this small counts as none: the place is on an edge, or at a corner.
constexpr double weight_tolerance = 1e-9;

/// Which of a facet's normals belongs to a place on it: a corner's, an edge's or its own.
template <int Dim>
int part_of(const std::array<double, Dim>& weights) {
  int absent = -1;
  int count = 0;
  int present = 0;
  for (int i = 0; i < Dim; ++i) {
    if (weights[i] > 0) {
      ++count;
      present = i;
    } else {
      absent = i;
    }
  }
  if (count == 1) return present;
  if (Dim == 3 && count == 2) return 3 + absent;
  return static_cast<int>(std::tuple_size_v<FacetNormals<Dim>>) - 1;
}

/// A polyline over [0, 1] by arc length, both ends exact.
class Polyline {
 public:
  Polyline(const BoundaryMesh<2>& mesh, const std::vector<int>& facets) {
    places_.push_back(mesh.vertices.col(mesh.facets[facets[0]].corners[0]));
    lengths_.push_back(0);
    for (int f : facets) {
      places_.push_back(mesh.vertices.col(mesh.facets[f].corners[1]));
      lengths_.push_back(lengths_.back() + mesh.facets[f].area.norm());
    }
  }
  Point<2> at(double t) const {
    if (t <= 0) return places_.front();
    if (t >= 1) return places_.back();
    const double length = t * lengths_.back();
    const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, length);
    const auto i = static_cast<std::size_t>(after - lengths_.begin());
    const double part = (length - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
    return places_[i - 1] + part * (places_[i] - places_[i - 1]);
  }

 private:
  std::vector<Point<2>> places_;
  std::vector<double> lengths_;  ///< from the first place
};

[[noreturn]] void fail_without_map() {
  throw SkipCase(
      "a mesh has no map from the unit cube; use --cloud file, which takes the mesh's own nodes, "
      "or, in 2D, --cloud scattered");
}

}  // namespace

template <int Dim>
MeshDomain<Dim>::MeshDomain(const Mesh& mesh, std::string path) : path_(std::move(path)) {
  try {
    read(mesh);
  } catch (const CaseError& error) {
    throw CaseError(fmt::format("{}: {}", path_, error.what()));
  }
}

template <int Dim>
void MeshDomain<Dim>::read(const Mesh& mesh) {
  for (const BoundaryGroup& group : mesh.groups) sides_.push_back(group.name);
  Topology<Dim> topology = topology_of<Dim>(mesh);
  assign_sides(sides_, mesh, topology);
  measure_ = topology.measure;
  boundary_ = boundary_of(topology);
  const Point<Dim> low = boundary_.vertices.rowwise().minCoeff();
  const Point<Dim> high = boundary_.vertices.rowwise().maxCoeff();
  extent_ = (high - low).maxCoeff();
  check_flat(mesh, topology, extent_);
  signs_ = sign_normals(boundary_);
  normals_ = corner_normals(boundary_);
  std::vector<int> all(boundary_.facets.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::vector<int>> by_side(sides_.size());
  for (int f : all) by_side[boundary_.facets[f].side].push_back(f);
  tree_ = std::make_unique<FacetTree<Dim>>(boundary_, std::move(all));
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    if (by_side[s].empty()) {
      throw CaseError(fmt::format(
          "physical group '{}' has no elements; mesh its entities, or remove it", sides_[s]));
    }
    tree_of_side_.push_back(std::make_unique<FacetTree<Dim>>(boundary_, std::move(by_side[s])));
  }
}

template <int Dim>
Point<Dim> MeshDomain<Dim>::map(const Point<Dim>&) const {
  fail_without_map();
}

template <int Dim>
std::vector<int> MeshDomain<Dim>::sides_at(const Point<Dim>&) const {
  fail_without_map();
}

template <int Dim>
Point<Dim> MeshDomain<Dim>::normal(int side, const Point<Dim>& x) const {
  const NearestPlace<Dim> place = tree_of_side_[side]->nearest(x);
  Point<Dim> sum = Point<Dim>::Zero();
  for (int i = 0; i < Dim; ++i) {
    if (place.weights[i] > 1 - weight_tolerance) return normals_.at[place.facet][i];
    sum += place.weights[i] * normals_.between[place.facet][i];
  }
  return sum.normalized();
}

template <int Dim>
double MeshDomain<Dim>::distance(const Point<Dim>& x) const {
  const NearestPlace<Dim> place = tree_->nearest(x);
  const std::array<int, Dim>& corners = boundary_.facets[place.facet].corners;
  Point<Dim> offset = x;
  for (int i = 0; i < Dim; ++i) offset -= place.weights[i] * boundary_.vertices.col(corners[i]);
  const bool is_inside = offset.dot(signs_[place.facet][part_of<Dim>(place.weights)]) < 0;
  const double distance = std::sqrt(place.squared_distance);
  return is_inside ? -distance : distance;
}

template <int Dim>
std::vector<BoundaryPiece<Dim>> MeshDomain<Dim>::pieces() const {
  std::vector<BoundaryPiece<Dim>> result;
  if constexpr (Dim == 2) {
    for (const SmoothRun& run : smooth_runs(boundary_)) {
      const auto line = std::make_shared<const Polyline>(boundary_, run.facets);
      result.push_back(
          {run.side, [line](const BoundaryPiece<2>::Parameter& t) { return line->at(t[0]); }});
    }
  }
  return result;
}

template class MeshDomain<2>;
template class MeshDomain<3>;

}  // namespace strongpoint
