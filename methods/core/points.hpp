#pragma once

#include <string>

#include <Eigen/Core>
#include <fmt/format.h>

namespace strongpoint {

/// A position, (Dim), in the problem's length unit.
template <int Dim>
using Point = Eigen::Matrix<double, Dim, 1>;

/// Positions, (Dim, N): one column per node.
template <int Dim>
using Points = Eigen::Matrix<double, Dim, Eigen::Dynamic>;

/// Carries a space dimension as a type, so that generic lambdas can be called once per dimension.
template <int Dim>
struct Dimension {};

/// Formats a position as "(x, y, z)" for messages.
template <class Vector>
std::string format_point(const Vector& x) {
  std::string text = "(";
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    text += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", x[i]);
  }
  return text + ")";
}

}  // namespace strongpoint
