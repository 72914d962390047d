#include "bench/voronoi_rivals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <voro++/voro++.hh>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

namespace strongpoint {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Ids of points in the order of a Hilbert curve.
template <class Position, template <class, class> class Adapter>
std::vector<std::size_t> hilbert_order(const std::vector<Position>& positions) {
  std::vector<std::size_t> order(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto map = CGAL::make_property_map(positions);
  CGAL::hilbert_sort(order.begin(), order.end(), Adapter<Kernel, decltype(map)>(map));
  return order;
}

template <int Dim>
Points<Dim> reordered(const Points<Dim>& nodes, const std::vector<std::size_t>& order) {
  Points<Dim> sorted(Dim, nodes.cols());
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.col(static_cast<Eigen::Index>(i)) = nodes.col(static_cast<Eigen::Index>(order[i]));
  }
  return sorted;
}

}  // namespace

template <>
Points<2> in_spatial_order<2>(const Points<2>& nodes) {
  std::vector<Kernel::Point_2> positions;
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) positions.emplace_back(nodes(0, i), nodes(1, i));
  return reordered<2>(
      nodes, hilbert_order<Kernel::Point_2, CGAL::Spatial_sort_traits_adapter_2>(positions));
}

template <>
Points<3> in_spatial_order<3>(const Points<3>& nodes) {
  std::vector<Kernel::Point_3> positions;
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
    positions.emplace_back(nodes(0, i), nodes(1, i), nodes(2, i));
  }
  return reordered<3>(
      nodes, hilbert_order<Kernel::Point_3, CGAL::Spatial_sort_traits_adapter_3>(positions));
}

std::vector<double> rival_measures(const Points<2>& nodes) {
  using Vertex = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
  using Face = CGAL::Triangulation_face_base_with_info_2<Kernel::Point_2, Kernel>;
  using Triangulation =
      CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, Face>>;
  std::vector<std::pair<Kernel::Point_2, int>> points;
  points.reserve(static_cast<std::size_t>(nodes.cols()));
  for (int i = 0; i < nodes.cols(); ++i) points.push_back({{nodes(0, i), nodes(1, i)}, i});
  Triangulation triangulation(points.begin(), points.end());
  for (auto face : triangulation.finite_face_handles()) face->info() = triangulation.dual(face);
  std::vector<double> measures(points.size(), 0);
  for (const auto& [face, i] : triangulation.finite_edges()) {
    const auto other = face->neighbor(i);
    const auto a = face->vertex(Triangulation::cw(i));
    const auto b = face->vertex(Triangulation::ccw(i));
    double part = std::numeric_limits<double>::quiet_NaN();
    if (!triangulation.is_infinite(face) && !triangulation.is_infinite(other)) {
      const Kernel::Point_2& from = face->info();
      const Kernel::Point_2& to = other->info();
      const bool inside = std::min({from.x(), from.y(), to.x(), to.y()}) >= 0 &&
                          std::max({from.x(), from.y(), to.x(), to.y()}) <= 1;
      // Each of the two nodes sees the edge of its cell at half their distance.
      if (inside) {
        part = 0.25 * std::sqrt(CGAL::squared_distance(a->point(), b->point()) *
                                CGAL::squared_distance(from, to));
      }
    }
    measures[a->info()] += part;
    measures[b->info()] += part;
  }
  return measures;
}

std::vector<double> rival_measures(const Points<3>& nodes) {
  constexpr double nodes_a_block = 6;
  const int blocks =
      std::max(1, static_cast<int>(std::cbrt(static_cast<double>(nodes.cols()) / nodes_a_block)));
  voro::container container(0, 1, 0, 1, 0, 1, blocks, blocks, blocks, false, false, false, 8);
  for (int i = 0; i < nodes.cols(); ++i) container.put(i, nodes(0, i), nodes(1, i), nodes(2, i));
  std::vector<double> measures(static_cast<std::size_t>(nodes.cols()), 0);
  voro::c_loop_all loop(container);
  voro::voronoicell cell;
  if (loop.start()) {
    do {
      if (container.compute_cell(cell, loop)) measures[loop.pid()] = cell.volume();
    } while (loop.inc());
  }
  return measures;
}

}  // namespace strongpoint
