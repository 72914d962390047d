#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

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

/// What a cloud is made from.
struct Mesh {
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

/// A facet of a volume element: how often it occurs, and its area vector out of the first element.
template <int Dim>
struct Facet {
  int elements = 0;
  bool has_side = false;
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
      std::sort(tags.begin(), tags.end());
      Facet<Dim>& facet = result.facets[tags];
      if (facet.elements++ == 0) facet.area = area;
    }
  }
  return result;
}

}  // namespace strongpoint
