#include "methods/core/end_splines.hpp"

#include <algorithm>

namespace strongpoint {
namespace {

/// (t - xi)_+^3 with two derivatives by xi.
std::array<double, 3> truncated_cube(double t, double xi) {
  const double left = std::max(0.0, t - xi);
  return {left * left * left, -3 * left * left, 6 * left};
}

}  // namespace

EndSplines::EndSplines(double xi, double h, double width) : rest_at_end(h + width / 3) {
  const double inner = 3 * h;
  const std::array<double, 3> near = truncated_cube(inner, xi);
  const std::array<double, 3> far = truncated_cube(width, xi);
  const double cube = inner * inner * inner;
  for (int k = 0; k < 3; ++k) {
    first[k] = near[k] / cube;
    second[k] = (far[k] / (width * width) - width * near[k] / cube) / (width - inner);
  }
  second[0] = std::max(0.0, second[0]);  // but for round-off
}

double end_spline_width(double h, double third, double widest) {
  return std::max(4 * h, 3 * third + widest - 3 * h);
}

}  // namespace strongpoint
