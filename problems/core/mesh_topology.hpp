#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "methods/core/error.hpp"
#include "methods/core/points.hpp"

namespace strongpoint {

/// Number of a node in a mesh file.
using Tag = std::size_t;
/// Numbers of several nodes.
using Tags = std::vector<Tag>;

/// A named group of boundary elements, each a list of node tags.
struct BoundaryGroup {
  std::string name;
  std::vector<Tags> elements;
};

/// An element of the mesh's own dimension.
struct VolumeElement {
  int type;  ///< Gmsh's number of the element type
  Tags nodes;
};

/// What a cloud or a domain is made from.
struct Mesh {
  int dimension = 0;                           ///< of the elements
  std::map<Tag, std::array<double, 3>> nodes;  ///< every node of the file
  std::vector<VolumeElement> elements;
  std::vector<BoundaryGroup> groups;
};

/// Facets of a first-order element as local node numbers, by Gmsh's element type.
/// Throws CaseError for any other type.
inline const std::vector<std::vector<int>>& facets_of(int type) {
  static const std::map<int, std::vector<std::vector<int>>> all{
      {1, {{0}, {1}}},                                    // line
      {2, {{0, 1}, {1, 2}, {2, 0}}},                      // triangle
      {3, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},              // quadrangle
      {4, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}},  // tetrahedron
      {5, {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
      {6, {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},  // prism
      {7, {{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}}};       // pyramid
  const auto place = all.find(type);
  if (place != all.end()) return place->second;
  throw CaseError(fmt::format(
      "element type {} of Gmsh is not supported; mesh with first-order elements (gmsh -order 1)",
      type));
}

/// A facet of a volume element: how often it occurs, its nodes in the order of the first element,
/// and its area vector out of that.
template <int Dim>
struct Facet {
  int elements = 0;
  int side = -1;  ///< index of its physical group's name, -1 without one
  Tags corners;
  Point<Dim> area;
};

/// Facets by ascending node tags.
template <int Dim>
using Facets = std::map<Tags, Facet<Dim>>;

/// Normal times length or area of a facet, of either sign; a number of sign only in 1D.
template <int Dim>
Point<Dim> area_vector(const std::vector<Point<Dim>>& corners) {
  if constexpr (Dim == 1) {
    return Point<1>(1.0);
  } else if constexpr (Dim == 2) {
    const Point<2> edge = corners[1] - corners[0];
    return {edge[1], -edge[0]};
  } else {
    Point<3> sum = Point<3>::Zero();
    for (std::size_t i = 2; i < corners.size(); ++i) {
      sum += 0.5 * (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
    }
    return sum;
  }
}

/// Mean of some positions.
template <int Dim>
Point<Dim> mean_of(const std::vector<Point<Dim>>& corners) {
  Point<Dim> sum = Point<Dim>::Zero();
  for (const Point<Dim>& corner : corners) sum += corner;
  return sum / static_cast<double>(corners.size());
}

/// The elements' topology: facets, nodes in use and measure.
template <int Dim>
struct Topology {
  Facets<Dim> facets;
  std::map<Tag, Point<Dim>> nodes;
  double measure = 0;
};

/// Finds the facets of all elements. Throws CaseError for elements that are not of first order.
template <int Dim>
Topology<Dim> topology_of(const Mesh& mesh) {
  Topology<Dim> result;
  for (const VolumeElement& element : mesh.elements) {
    std::vector<Point<Dim>> corners;
    const std::vector<std::vector<int>>& facets = facets_of(element.type);
    for (Tag tag : element.nodes) {
      const std::array<double, 3>& x = mesh.nodes.at(tag);
      corners.push_back(Eigen::Map<const Point<3>>(x.data()).template head<Dim>());
      result.nodes.emplace(tag, corners.back());
    }
    const Point<Dim> centre = mean_of<Dim>(corners);
    for (const std::vector<int>& local : facets) {
      Tags tags;
      std::vector<Point<Dim>> own;
      for (int i : local) {
        tags.push_back(element.nodes[i]);
        own.push_back(corners[i]);
      }
      const Point<Dim> outwards = mean_of<Dim>(own) - centre;
      Point<Dim> area = area_vector<Dim>(own);
      if (area.dot(outwards) < 0) area = -area;
      // Gauss' theorem for the position about the centre.
      result.measure += area.dot(outwards) / Dim;
      Tags sorted = tags;
      std::sort(sorted.begin(), sorted.end());
      Facet<Dim>& facet = result.facets[sorted];
      if (facet.elements++ > 0) continue;
      facet.corners = std::move(tags);
      facet.area = area;
    }
  }
  return result;
}

/// Names of the mesh's groups, for messages.
inline std::string group_names(const Mesh& mesh) {
  std::string names;
  for (const BoundaryGroup& group : mesh.groups) names += (names.empty() ? "" : ", ") + group.name;
  return names.empty() ? "none" : names;
}

/// Throws CaseError naming a node unless coordinates beyond Dim vanish compared to a length.
template <int Dim>
void check_flat(const Mesh& mesh, const Topology<Dim>& topology, double length) {
  for (const auto& [tag, x] : topology.nodes) {
    for (int c = Dim; c < 3; ++c) {
      if (std::abs(mesh.nodes.at(tag)[c]) <= 1e-9 * std::abs(length)) continue;
      throw CaseError(fmt::format("node {} has {} = {}; a {}D mesh must have it zero", tag,
                                  "xyz"[c], mesh.nodes.at(tag)[c], Dim));
    }
  }
}

/// Gives each boundary facet the side that its physical group is named after. Throws CaseError for
/// a group that is no side, that is not on the boundary or that shares an element with another, and
/// for boundary without a side.
template <int Dim>
void assign_sides(const std::vector<std::string>& sides, const Mesh& mesh,
                  Topology<Dim>& topology) {
  for (const BoundaryGroup& group : mesh.groups) {
    const auto place = std::find(sides.begin(), sides.end(), group.name);
    if (place == sides.end()) {
      throw CaseError(
          fmt::format("physical group '{}' is not a side of the domain; known sides: {}; groups in "
                      "the file: {}",
                      group.name, fmt::join(sides, ", "), group_names(mesh)));
    }
    const auto side = static_cast<int>(place - sides.begin());
    for (Tags tags : group.elements) {
      std::sort(tags.begin(), tags.end());
      const auto facet = topology.facets.find(tags);
      if (facet == topology.facets.end() || facet->second.elements != 1) {
        throw CaseError(fmt::format(
            "an element of physical group '{}' (nodes {}) is not on the boundary of the mesh; keep "
            "only boundary entities in the group",
            group.name, fmt::join(tags, ", ")));
      }
      if (facet->second.side >= 0 && facet->second.side != side) {
        throw CaseError(fmt::format(
            "an element (nodes {}) is in both physical groups '{}' and '{}'; keep it in one",
            fmt::join(tags, ", "), sides[facet->second.side], group.name));
      }
      facet->second.side = side;
    }
  }
  for (const auto& [tags, facet] : topology.facets) {
    if (facet.elements != 1 || facet.side >= 0) continue;
    throw CaseError(fmt::format(
        "boundary node {} at {} (element with nodes {}) has no side; put its boundary into a "
        "physical group named after one of: {}; groups in the file: {}",
        tags[0], format_point(topology.nodes.at(tags[0])), fmt::join(tags, ", "),
        fmt::join(sides, ", "), group_names(mesh)));
  }
}

}  // namespace strongpoint
