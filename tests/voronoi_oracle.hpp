#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <Eigen/Geometry>

#include "problems/core/point_cloud.hpp"

namespace strongpoint {

/// Whether a position lies in the closed unit cube.
template <int Dim>
bool inside_cube(const Point<Dim>& x) {
  return (x.array() >= 0).all() && (x.array() <= 1).all();
}

/// Areas of the cells that lie inside the unit square, from the Delaunay triangulation; -1 for the
/// rest.
inline std::vector<double> cgal_measures(const PointCloud<2>& cloud) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Vertex = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
  using Triangulation =
      CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;
  std::vector<std::pair<Kernel::Point_2, int>> points;
  points.reserve(static_cast<std::size_t>(cloud.size()));
  for (int i = 0; i < cloud.size(); ++i)
    points.push_back({{cloud.nodes(0, i), cloud.nodes(1, i)}, i});
  const Triangulation triangulation(points.begin(), points.end());
  std::vector<double> measures(points.size(), -1);
  for (auto v : triangulation.finite_vertex_handles()) {
    std::vector<Point<2>> corners;
    bool bounded = true;
    auto face = triangulation.incident_faces(v);
    const auto first = face;
    do {
      bounded = bounded && !triangulation.is_infinite(face);
      if (!bounded) break;
      const Kernel::Point_2 c = triangulation.dual(face);
      corners.push_back(Point<2>(c.x(), c.y()) - cloud.nodes.col(v->info()));
      bounded = inside_cube<2>({c.x(), c.y()});
    } while (++face != first);
    if (!bounded) continue;
    double twice = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point<2>& a = corners[i];
      const Point<2>& b = corners[(i + 1) % corners.size()];
      twice += a[0] * b[1] - a[1] * b[0];
    }
    measures[v->info()] = twice / 2;
  }
  return measures;
}

/// Area of a planar polygon in space.
inline double polygon_area(const std::vector<Point<3>>& corners) {
  Point<3> twice = Point<3>::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    twice += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  }
  return twice.norm() / 2;
}

/// Volumes of the cells that lie inside the unit cube: pyramids over the facets dual to the
/// Delaunay edges; -1 for the rest.
inline std::vector<double> cgal_measures(const PointCloud<3>& cloud) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Vertex = CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>;
  using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
  using Triangulation =
      CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
  std::vector<std::pair<Kernel::Point_3, int>> points;
  points.reserve(static_cast<std::size_t>(cloud.size()));
  for (int i = 0; i < cloud.size(); ++i) {
    points.push_back({{cloud.nodes(0, i), cloud.nodes(1, i), cloud.nodes(2, i)}, i});
  }
  const Triangulation triangulation(points.begin(), points.end());
  std::vector<double> measures(points.size(), 0);
  for (const auto& edge : triangulation.finite_edges()) {
    const int a = edge.first->vertex(edge.second)->info();
    const int b = edge.first->vertex(edge.third)->info();
    std::vector<Point<3>> corners;
    bool bounded = true;
    auto cell = triangulation.incident_cells(edge);
    const auto first = cell;
    do {
      bounded = bounded && !triangulation.is_infinite(cell);
      if (!bounded) break;
      const Kernel::Point_3 c = triangulation.dual(cell);
      corners.emplace_back(c.x(), c.y(), c.z());
      bounded = inside_cube<3>(corners.back());
    } while (++cell != first);
    const double part =
        bounded ? polygon_area(corners) * (cloud.nodes.col(a) - cloud.nodes.col(b)).norm() / 6
                : NAN;
    measures[a] += part;
    measures[b] += part;
  }
  for (double& measure : measures) measure = std::isnan(measure) ? -1 : measure;
  return measures;
}

}  // namespace strongpoint
