#include "problems/core/domains/boundary_mesh.hpp"

#include <cmath>
#include <numbers>

namespace strongpoint {
namespace {

const double crease_cosine = std::cos(crease_angle_degrees * std::numbers::pi / 180);

/// Turns corners so that their own normal points outwards.
template <int Dim>
BoundaryFacet<Dim> oriented(std::array<int, Dim> corners, const Points<Dim>& vertices, int side,
                            const Point<Dim>& outwards) {
  std::vector<Point<Dim>> places;
  places.reserve(Dim);
  for (int corner : corners) places.push_back(vertices.col(corner));
  Point<Dim> area = area_vector<Dim>(places);
  if (area.dot(outwards) < 0) {
    std::swap(corners[0], corners[1]);
    area = -area;
  }
  return {corners, side, area};
}

[[noreturn]] void fail_touching(const std::string& place) {
  throw CaseError(fmt::format(
      "the boundary touches itself at {}; leave a gap there, or join the parts", place));
}

/// The facets around each vertex.
template <int Dim>
std::vector<std::vector<int>> facets_around(const BoundaryMesh<Dim>& mesh) {
  std::vector<std::vector<int>> around(static_cast<std::size_t>(mesh.vertices.cols()));
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int corner : mesh.facets[f].corners) around[corner].push_back(static_cast<int>(f));
  }
  return around;
}

/// Angle of a triangle at its corner i.
double angle_at(const BoundaryMesh<3>& mesh, const BoundaryFacet<3>& facet, int i) {
  const Point<3> x = mesh.vertices.col(facet.corners[i]);
  const Point<3> a = mesh.vertices.col(facet.corners[(i + 1) % 3]) - x;
  const Point<3> b = mesh.vertices.col(facet.corners[(i + 2) % 3]) - x;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Adds the normals of the two triangles at each edge.
void add_edge_normals(const BoundaryMesh<3>& mesh, std::vector<FacetNormals<3>>& normals) {
  std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, int>>> edges;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const int a = mesh.facets[f].corners[(i + 1) % 3];
      const int b = mesh.facets[f].corners[(i + 2) % 3];
      edges[std::minmax(a, b)].emplace_back(f, i);
    }
  }
  for (const auto& [ends, places] : edges) {
    if (places.size() != 2) fail_touching(format_point(mesh.vertices.col(ends.first)));
    const Point<3> sum =
        mesh.facets[places[0].first].normal() + mesh.facets[places[1].first].normal();
    for (const auto& [f, i] : places) normals[f][3 + i] = sum;
  }
}

}  // namespace

template <int Dim>
BoundaryMesh<Dim> boundary_of(const Topology<Dim>& topology) {
  BoundaryMesh<Dim> mesh;
  std::map<Tag, int> numbers;
  for (const auto& [tags, facet] : topology.facets) {
    if (facet.elements != 1) continue;
    for (Tag tag : tags) numbers.emplace(tag, 0);
  }
  mesh.vertices.resize(Dim, static_cast<Eigen::Index>(numbers.size()));
  int next = 0;
  for (auto& [tag, number] : numbers) {
    number = next++;
    mesh.vertices.col(number) = topology.nodes.at(tag);
  }
  for (const auto& [tags, facet] : topology.facets) {
    if (facet.elements != 1) continue;
    std::vector<int> corners;
    corners.reserve(facet.corners.size());
    for (Tag tag : facet.corners) corners.push_back(numbers.at(tag));
    for (std::size_t i = Dim - 1; i < corners.size(); ++i) {  // a fan around the first
      std::array<int, Dim> own{};
      own[0] = corners[0];
      for (int j = 1; j < Dim; ++j) own[j] = corners[i - (Dim - 1) + j];
      mesh.facets.push_back(oriented<Dim>(own, mesh.vertices, facet.side, facet.area));
    }
  }
  return mesh;
}

template <int Dim>
std::vector<FacetNormals<Dim>> sign_normals(const BoundaryMesh<Dim>& mesh) {
  Points<Dim> sums = Points<Dim>::Zero(Dim, mesh.vertices.cols());
  for (const BoundaryFacet<Dim>& facet : mesh.facets) {
    for (int i = 0; i < Dim; ++i) {
      double weight = 1;
      if constexpr (Dim == 3) weight = angle_at(mesh, facet, i);
      sums.col(facet.corners[i]) += weight * facet.normal();
    }
  }
  std::vector<FacetNormals<Dim>> normals(mesh.facets.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int i = 0; i < Dim; ++i) normals[f][i] = sums.col(mesh.facets[f].corners[i]);
    normals[f].back() = mesh.facets[f].normal();
  }
  if constexpr (Dim == 3) {
    add_edge_normals(mesh, normals);
  } else {
    const std::vector<std::vector<int>> around = facets_around(mesh);
    for (std::size_t v = 0; v < around.size(); ++v) {
      if (around[v].size() == 2) continue;
      fail_touching(format_point(mesh.vertices.col(static_cast<Eigen::Index>(v))));
    }
  }
  return normals;
}

template <int Dim>
CornerNormals<Dim> corner_normals(const BoundaryMesh<Dim>& mesh) {
  const std::vector<std::vector<int>> around = facets_around(mesh);
  CornerNormals<Dim> result;
  result.at.resize(mesh.facets.size());
  result.between.resize(mesh.facets.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const BoundaryFacet<Dim>& facet = mesh.facets[f];
    for (int i = 0; i < Dim; ++i) {
      Point<Dim> all = Point<Dim>::Zero();
      Point<Dim> smooth = Point<Dim>::Zero();
      for (int other : around[facet.corners[i]]) {
        const BoundaryFacet<Dim>& neighbour = mesh.facets[other];
        if (neighbour.side != facet.side) continue;
        all += neighbour.area;
        if (neighbour.normal().dot(facet.normal()) > crease_cosine) smooth += neighbour.area;
      }
      const bool cancel = !(all.norm() > 1e-9 * facet.area.norm());  // the two faces of a sheet
      result.at[f][i] = cancel ? facet.normal() : Point<Dim>(all.normalized());
      result.between[f][i] = smooth.normalized();
    }
  }
  return result;
}

std::vector<SmoothRun> smooth_runs(const BoundaryMesh<2>& mesh) {
  const std::size_t count = mesh.facets.size();
  std::vector<int> from(count);  // facet that begins at a vertex
  for (std::size_t f = 0; f < count; ++f) from[mesh.facets[f].corners[0]] = static_cast<int>(f);
  const auto next = [&](int f) { return from[mesh.facets[f].corners[1]]; };
  std::vector<char> begins(count, 0);
  for (std::size_t f = 0; f < count; ++f) {
    const BoundaryFacet<2>& here = mesh.facets[f];
    const int after = next(static_cast<int>(f));
    const BoundaryFacet<2>& there = mesh.facets[after];
    const bool is_smooth = here.normal().dot(there.normal()) > crease_cosine;
    if (here.side != there.side || !is_smooth) begins[after] = 1;
  }
  std::vector<char> is_used(count, 0);
  std::vector<SmoothRun> runs;
  const auto follow = [&](int first) {
    SmoothRun run{mesh.facets[first].side, {}};
    for (int f = first; is_used[f] == 0 && (f == first || begins[f] == 0); f = next(f)) {
      run.facets.push_back(f);
      is_used[f] = 1;
    }
    runs.push_back(std::move(run));
  };
  for (std::size_t f = 0; f < count; ++f) {
    if (begins[f] != 0) follow(static_cast<int>(f));
  }
  for (std::size_t f = 0; f < count; ++f) {  // closed curves of one side
    if (is_used[f] == 0) follow(static_cast<int>(f));
  }
  return runs;
}

template BoundaryMesh<2> boundary_of(const Topology<2>&);
template BoundaryMesh<3> boundary_of(const Topology<3>&);
template std::vector<FacetNormals<2>> sign_normals(const BoundaryMesh<2>&);
template std::vector<FacetNormals<3>> sign_normals(const BoundaryMesh<3>&);
template CornerNormals<2> corner_normals(const BoundaryMesh<2>&);
template CornerNormals<3> corner_normals(const BoundaryMesh<3>&);

}  // namespace strongpoint
