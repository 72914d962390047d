#include "problems/core/elastic_conditions.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace strongpoint {
namespace {

/// Round-off of a mesh file's digits, relative to the extent of the mesh.
constexpr double flatness = 1e-6;
/// A probe may lie this far outside, relative to the extent: curved sides are polylines.
constexpr double probe_tolerance = 1e-2;

/// The side that a group is, looked up for a line of the case.
template <int Dim>
std::size_t side_of(const ElasticCase& elastic, const MeshDomain<Dim>& domain, const char* section,
                    const std::string& group, int line) {
  const std::vector<std::string>& sides = domain.sides();
  const auto found = std::find(sides.begin(), sides.end(), group);
  if (found != sides.end()) return static_cast<std::size_t>(found - sides.begin());
  fail_in_case(
      elastic, line,
      fmt::format("[{}.{}]: the mesh has no physical group '{}' of dimension {}; known: {}",
                  section, group, group, Dim - 1, fmt::join(sides, ", ")));
}

/// A list of numbers as a vector of the mesh's dimension.
template <int Dim>
Point<Dim> vector_of(const ElasticCase& elastic, int line, const std::string& what,
                     const std::vector<double>& values) {
  if (values.size() != Dim) {
    fail_in_case(
        elastic, line,
        fmt::format("{} has {} numbers, but the mesh {} dimensions", what, values.size(), Dim));
  }
  return Eigen::Map<const Point<Dim>>(values.data());
}

/// The plane that a side lies in. Throws unless it is one of symmetry.
template <int Dim>
SymmetryPlane plane_of(const ElasticCase& elastic, const MeshDomain<Dim>& domain,
                       const SupportSpec& support, std::size_t side) {
  const BoundaryMesh<Dim>& mesh = domain.boundary();
  const auto own = [&](const BoundaryFacet<Dim>& facet) {
    return facet.side == static_cast<int>(side);
  };
  const auto first = std::find_if(mesh.facets.begin(), mesh.facets.end(), own);
  int axis = 0;
  first->area.cwiseAbs().maxCoeff(&axis);
  const double offset = mesh.vertices(axis, first->corners[0]);
  const double tolerance = flatness * domain.reference_length();
  for (const BoundaryFacet<Dim>& facet : mesh.facets) {
    if (!own(facet)) continue;
    for (int corner : facet.corners) {
      if (std::abs(mesh.vertices(axis, corner) - offset) <= tolerance) continue;
      fail_in_case(elastic, support.line,
                   fmt::format("[support.{0}]: symmetry needs a side in one plane x, y or z = "
                               "constant, which '{0}' leaves at {1}; split the group, or give ux, "
                               "uy or uz",
                               support.group, format_point(mesh.vertices.col(corner))));
    }
  }
  const double outwards = first->area[axis] > 0 ? 1 : -1;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    if (outwards * (mesh.vertices(axis, v) - offset) <= tolerance) continue;
    fail_in_case(elastic, support.line,
                 fmt::format("[support.{}]: the mesh lies on both sides of this plane of symmetry, "
                             "as at {}; give u{} = 0 instead",
                             support.group, format_point(mesh.vertices.col(v)), "xyz"[axis]));
  }
  return {static_cast<int>(side), axis, offset};
}

template <int Dim>
void add_support(const ElasticCase& elastic, const MeshDomain<Dim>& domain,
                 const SupportSpec& support, ElasticConditions<Dim>& conditions) {
  const std::size_t side = side_of(elastic, domain, "support", support.group, support.line);
  std::array<std::optional<double>, Dim>& displacement = conditions.sides[side].displacement;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!support.displacement[c]) continue;
    if (c >= Dim) {
      fail_in_case(elastic, support.line,
                   fmt::format("[support.{}]: u{} is given, but the mesh has {} dimensions",
                               support.group, "xyz"[c], Dim));
    }
    displacement[c] = support.displacement[c];
  }
  if (!support.is_symmetry) return;
  conditions.symmetry_planes.push_back(plane_of(elastic, domain, support, side));
  displacement[conditions.symmetry_planes.back().axis] = 0;
}

/// Displacement along an axis of each rigid motion at a place: translations first.
template <int Dim>
Eigen::VectorXd rigid_motions(const Point<Dim>& x, int axis) {
  constexpr int count = Dim * (Dim + 1) / 2;
  Eigen::VectorXd motions = Eigen::VectorXd::Zero(count);
  motions[axis] = 1;
  int next = Dim;
  for (int i = 0; i < Dim; ++i) {
    for (int j = i + 1; j < Dim; ++j, ++next) {
      if (axis == i) motions[next] = -x[j];
      if (axis == j) motions[next] = x[i];
    }
  }
  return motions;
}

/// Throws unless the supports hold the body, as seen from the vertices of their sides.
template <int Dim>
void check_held(const ElasticCase& elastic, const MeshDomain<Dim>& domain,
                const ElasticConditions<Dim>& conditions) {
  constexpr int count = Dim * (Dim + 1) / 2;
  const BoundaryMesh<Dim>& mesh = domain.boundary();
  const Point<Dim> centre = mesh.vertices.rowwise().mean();
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(count, count);
  for (const BoundaryFacet<Dim>& facet : mesh.facets) {
    for (int corner : facet.corners) {
      const Point<Dim> x = (mesh.vertices.col(corner) - centre) / domain.reference_length();
      for (int i = 0; i < Dim; ++i) {
        if (!conditions.sides[facet.side].displacement[i]) continue;
        const Eigen::VectorXd motions = rigid_motions<Dim>(x, i);
        held += motions * motions.transpose();
      }
    }
  }
  constexpr double singular = 1e-10;
  const double largest = held.diagonal().maxCoeff();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(held);
  if (largest > 0 && eigen.eigenvalues()[0] > singular * largest) return;
  std::vector<std::string> free;
  for (int i = 0; i < Dim; ++i) {
    if (held(i, i) <= singular * largest) free.push_back(fmt::format("along {}", "xyz"[i]));
  }
  fail_in_case(elastic, 0,
               fmt::format("the supports leave the body free to {}{}; add [support.GROUP] for one "
                           "of: {}",
                           free.empty() ? "turn" : "move ", fmt::join(free, " and "),
                           fmt::join(domain.sides(), ", ")));
}

}  // namespace

template <int Dim>
ElasticConditions<Dim> conditions_of(const ElasticCase& elastic, const MeshDomain<Dim>& domain) {
  ElasticConditions<Dim> conditions;
  conditions.sides.resize(domain.sides().size());
  if (Dim == 3 && elastic.state_line > 0) {
    fail_in_case(elastic, elastic.state_line, "state is for meshes in the plane; remove it");
  }
  for (const SupportSpec& support : elastic.supports) {
    add_support(elastic, domain, support, conditions);
  }
  for (const LoadSpec& load : elastic.loads) {
    const std::size_t side = side_of(elastic, domain, "load", load.group, load.line);
    conditions.sides[side].pressure = load.pressure;
    if (load.traction.empty()) continue;
    conditions.sides[side].traction = vector_of<Dim>(
        elastic, load.line, fmt::format("[load.{}] traction", load.group), load.traction);
  }
  if (!elastic.force.empty()) {
    conditions.force = vector_of<Dim>(elastic, elastic.force_line, "[body] force", elastic.force);
  }
  for (const ProbeSpec& probe : elastic.probes) {
    const Point<Dim> place =
        vector_of<Dim>(elastic, probe.line, fmt::format("the probe {}", probe.name), probe.place);
    const double outside = domain.distance(place);
    if (outside > probe_tolerance * domain.reference_length()) {
      fail_in_case(elastic, probe.line,
                   fmt::format("the probe {} at {} is {:.3g} outside of the mesh", probe.name,
                               format_point(place), outside));
    }
    conditions.probes.push_back(place);
  }
  check_held(elastic, domain, conditions);
  return conditions;
}

template ElasticConditions<2> conditions_of(const ElasticCase&, const MeshDomain<2>&);
template ElasticConditions<3> conditions_of(const ElasticCase&, const MeshDomain<3>&);

}  // namespace strongpoint
