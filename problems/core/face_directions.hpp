#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/QR>

#include "problems/core/point_cloud.hpp"

namespace strongpoint {

/// Unit vectors that span what is left of the free axes beside the normals given.
template <int Dim>
std::vector<Point<Dim>> directions_beside(const std::vector<int>& free_axes,
                                          std::span<const BoundaryMark<Dim>> faces) {
  const auto axes = static_cast<Eigen::Index>(free_axes.size());
  Eigen::MatrixXd normals(axes, static_cast<Eigen::Index>(faces.size()));
  for (Eigen::Index a = 0; a < axes; ++a) {
    for (Eigen::Index f = 0; f < normals.cols(); ++f) {
      normals(a, f) = faces[f].normal[free_axes[a]];
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(normals);
  const Eigen::MatrixXd basis = qr.householderQ();
  std::vector<Point<Dim>> directions;
  for (Eigen::Index k = normals.cols(); k < axes; ++k) {
    Point<Dim> direction = Point<Dim>::Zero();
    for (Eigen::Index a = 0; a < axes; ++a) direction[free_axes[a]] = basis(a, k);
    directions.push_back(direction);
  }
  return directions;
}

/// The part of a normal along the free axes, of unit length.
template <int Dim>
Point<Dim> within(const std::vector<int>& free_axes, const Point<Dim>& normal) {
  Point<Dim> part = Point<Dim>::Zero();
  for (int axis : free_axes) part[axis] = normal[axis];
  const double length = part.norm();
  return length > 0 ? Point<Dim>(part / length) : part;
}

/// False where two faces meet smoothly, at less than some 20 degrees, or back to back, as seen
/// along the free axes: their normal tractions say nearly the same. False too for a face that lies
/// that close across the free axes: its normal traction is in the place of a displacement given.
template <int Dim>
bool are_apart(const std::vector<int>& free_axes, std::span<const BoundaryMark<Dim>> faces) {
  constexpr double cosine = 0.94;
  constexpr double sine = 0.34;
  for (std::size_t a = 0; a < faces.size(); ++a) {
    const Point<Dim> part = within<Dim>(free_axes, faces[a].normal);
    if (std::abs(part.dot(faces[a].normal)) < sine) return false;
    for (std::size_t b = a + 1; b < faces.size(); ++b) {
      if (std::abs(part.dot(within<Dim>(free_axes, faces[b].normal))) > cosine) return false;
    }
  }
  return true;
}

}  // namespace strongpoint
