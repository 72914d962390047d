#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// The edges of a boundary piece as curves in its parameters: the piece itself in 2D, the four rims
/// of the parameter square in 3D.
template <int Dim>
std::vector<std::function<typename BoundaryPiece<Dim>::Parameter(double)>> rims() {
  using Parameter = typename BoundaryPiece<Dim>::Parameter;
  if constexpr (Dim == 2) {
    return {[](double t) { return Parameter(t); }};
  } else {
    return {[](double t) { return Parameter(t, 0); }, [](double t) { return Parameter(t, 1); },
            [](double t) { return Parameter(0, t); }, [](double t) { return Parameter(1, t); }};
  }
}

/// A node of a boundary piece with its place in the piece's parameters.
template <int Dim>
struct FrontNode {
  typename BoundaryPiece<Dim>::Parameter parameter;
  Point<Dim> x;
};

/// Derivative of a face's map, (3, 2), by central differences that stay in the parameter square.
inline Eigen::Matrix<double, 3, 2> jacobian(const BoundaryPiece<3>& piece,
                                            const Eigen::Vector2d& at) {
  constexpr double step = 1e-5;
  Eigen::Matrix<double, 3, 2> result;
  for (int c = 0; c < 2; ++c) {
    Eigen::Vector2d low = at, high = at;
    low[c] = std::max(0.0, at[c] - step);
    high[c] = std::min(1.0, at[c] + step);
    result.col(c) = (piece.map(high) - piece.map(low)) / (high[c] - low[c]);
  }
  return result;
}

/// Distance from a point of a face to the face's rims, estimated along the parameter lines.
inline double rim_distance(const BoundaryPiece<3>& piece, const FrontNode<3>& node) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 2; ++c) {
    for (double end : {0.0, 1.0}) {
      Eigen::Vector2d foot = node.parameter;
      foot[c] = end;
      nearest = std::min(nearest, (piece.map(foot) - node.x).norm());
    }
  }
  return nearest;
}

/// The point a physical distance away in a direction of the parameter square; false when it leaves
/// the square. The length of the parameter step is corrected for curvature.
inline bool step_on_face(const BoundaryPiece<3>& piece, const FrontNode<3>& from,
                         Eigen::Vector2d direction, double distance, FrontNode<3>& to) {
  constexpr int corrections = 3;
  for (int i = 0; i <= corrections; ++i) {
    to.parameter = from.parameter + direction;
    if ((to.parameter.array() < 0).any() || (to.parameter.array() > 1).any()) return false;
    to.x = piece.map(to.parameter);
    const double reached = (to.x - from.x).norm();
    if (!(reached > 0)) return false;
    direction *= distance / reached;
  }
  return true;
}

}  // namespace strongpoint
