#pragma once

#include "problems/core/domain.hpp"

namespace strongpoint {

/// Gradient of a domain's distance at x by central differences of half width `step`; along the
/// outward normal near the boundary.
template <int Dim>
Point<Dim> distance_gradient(const Domain<Dim>& domain, const Point<Dim>& x, double step) {
  Point<Dim> gradient;
  for (int c = 0; c < Dim; ++c) {
    Point<Dim> ahead = x;
    Point<Dim> behind = x;
    ahead[c] += step;
    behind[c] -= step;
    gradient[c] = (domain.distance(ahead) - domain.distance(behind)) / (ahead[c] - behind[c]);
  }
  return gradient;
}

}  // namespace strongpoint
