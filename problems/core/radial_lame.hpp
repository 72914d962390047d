#pragma once

#include <array>
#include <cmath>

#include "problems/core/elasticity.hpp"

namespace strongpoint {

/// Displacement u = (A + B / |x|^Dim) x of a tube (2D, plane strain) or hollow sphere (3D) a < |x|
/// < b with pressure p inside and a free outside, from sigma_r = (Dim lambda + 2 mu) A - 2 (Dim -
/// 1) mu B / r^Dim. Generic in its number type. Source: Lame and Clapeyron 1831; Timoshenko and
/// Goodier, Theory of elasticity, sections 28 and 136.
template <int Dim>
class RadialLame {
 public:
  /// Takes the radii 0 < a < b.
  RadialLame(double a, double b, double pressure, const Lame& material) {
    const double inner = std::pow(a, Dim), outer = std::pow(b, Dim);
    const double load = pressure * inner / (outer - inner);
    uniform_ = load / (Dim * material.lambda + 2 * material.mu);
    decaying_ = load * outer / (2 * (Dim - 1) * material.mu);
  }

  template <class T>
  std::array<T, Dim> operator()(const std::array<T, Dim>& x) const {
    using std::sqrt;
    T square = x[0] * x[0];
    for (int c = 1; c < Dim; ++c) square += x[c] * x[c];
    T power = square;
    if constexpr (Dim == 3) power *= sqrt(square);
    const T factor = uniform_ + decaying_ / power;
    std::array<T, Dim> u;
    for (int c = 0; c < Dim; ++c) u[c] = factor * x[c];
    return u;
  }

 private:
  double uniform_, decaying_;  ///< A and B
};

}  // namespace strongpoint
