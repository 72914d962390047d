#pragma once

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "problems/core/cell_faces.hpp"

namespace strongpoint {

/// Cells add up to the domain, and area vectors to zero, but for the round-off of thousands of
/// terms.
inline constexpr double sum_round_off = 1e-12;

/// The faces of a cloud.
template <int Dim>
CellFaces<Dim> faces_of(const PointCloud<Dim>& cloud, const Domain<Dim>& domain, int gauss = 2) {
  return cell_faces<Dim>(cloud, domain, *make_search<Dim>("auto", cloud.nodes), gauss);
}

/// Sum of the measures of all cells.
template <int Dim>
double total_measure(const PointCloud<Dim>& cloud, const CellFaces<Dim>& faces) {
  double sum = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    sum += cell_measure<Dim>(cloud.nodes.col(i), faces.of(i));
  }
  return sum;
}

/// Every point lies on a face or on a side, and the area vectors of every cell add up to zero.
template <int Dim>
void expect_closed_cells(const PointCloud<Dim>& cloud, const CellFaces<Dim>& faces) {
  for (int i = 0; i < cloud.size(); ++i) {
    Point<Dim> sum = Point<Dim>::Zero();
    double size = 0;
    for (const FacePoint<Dim>& point : faces.of(i)) {
      EXPECT_NE(point.side < 0, point.neighbour < 0) << "node " << i;
      sum += point.area;
      size += point.area.norm();
    }
    EXPECT_LT(sum.norm(), sum_round_off * size) << "node " << i;
  }
}

/// Every face between two cells has the same points from both sides, by the round-off of vertices
/// where bisectors are almost parallel. Edges that only one cell sees, because more than Dim + 1
/// cells meet there, are as short as that.
template <int Dim>
void expect_shared_faces(const PointCloud<Dim>& cloud, const CellFaces<Dim>& faces) {
  const double h = cloud.spacing();
  const double vertex_round_off = 1e-10 * h;
  const double area_round_off = 1e-10 * std::pow(h, Dim - 1);
  for (int i = 0; i < cloud.size(); ++i) {
    for (const FacePoint<Dim>& point : faces.of(i)) {
      if (point.neighbour < 0 || point.area.norm() < area_round_off) continue;
      bool is_shared = false;
      for (const FacePoint<Dim>& other : faces.of(point.neighbour)) {
        is_shared =
            is_shared || (other.neighbour == i && (other.x - point.x).norm() < vertex_round_off &&
                          (other.area + point.area).norm() < area_round_off);
      }
      EXPECT_TRUE(is_shared) << "nodes " << i << " and " << point.neighbour << " at "
                             << format_point(point.x);
    }
  }
}

/// Lengths or areas of the sides as the cells see them.
template <int Dim>
std::vector<double> side_measures(const Domain<Dim>& domain, const CellFaces<Dim>& faces) {
  std::vector<double> sizes(domain.sides().size(), 0.0);
  for (const FacePoint<Dim>& point : faces.points) {
    if (point.side >= 0) sizes[point.side] += point.area.dot(domain.normal(point.side, point.x));
  }
  return sizes;
}

}  // namespace strongpoint
