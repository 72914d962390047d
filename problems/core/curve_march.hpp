#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/points.hpp"

namespace strongpoint {

/// Wanted distance between neighbouring nodes at a position.
template <int Dim>
using SpacingFunction = std::function<double(const Point<Dim>&)>;

/// A smooth curve over [0, 1].
template <int Dim>
using Curve = std::function<Point<Dim>(double)>;

/// The spacing at x. Throws CaseError, naming the place, unless it is positive and finite.
template <int Dim>
double checked_spacing(const SpacingFunction<Dim>& spacing, const Point<Dim>& x) {
  const double h = spacing(x);
  if (std::isfinite(h) && h > 0) return h;
  throw CaseError(fmt::format("the domain's spacing at {} is {}; it must be a positive number",
                              format_point(x), h));
}

/// Running integral of ds / h at equidistant parameters of a curve, (samples + 1), by the
/// trapezoidal rule along chords.
template <int Dim>
std::vector<double> running_intervals(const Curve<Dim>& curve, const SpacingFunction<Dim>& spacing,
                                      int samples) {
  std::vector<double> running{0.0};
  Point<Dim> last = curve(0);
  double last_density = 1 / checked_spacing(spacing, last);
  for (int i = 1; i <= samples; ++i) {
    const Point<Dim> x = curve(static_cast<double>(i) / samples);
    const double density = 1 / checked_spacing(spacing, x);
    running.push_back(running.back() + 0.5 * (x - last).norm() * (density + last_density));
    last = x;
    last_density = density;
  }
  return running;
}

/// Gives parameters of nodes along a curve, both ends included, equidistant in the integral of ds /
/// h. The number of intervals is that integral rounded, at least 1 (3 on a closed curve).
template <int Dim>
std::vector<double> march(const Curve<Dim>& curve, const SpacingFunction<Dim>& spacing) {
  constexpr int most_samples = 1 << 16;
  constexpr double accuracy = 1e-6;  // two descriptions of a curve then place nodes alike
  int samples = 64;
  std::vector<double> running = running_intervals(curve, spacing, samples);
  for (double before = -1;
       std::abs(running.back() - before) > accuracy * running.back() && samples < most_samples;) {
    before = running.back();
    samples *= 2;
    running = running_intervals(curve, spacing, samples);
  }
  const double total = running.back();
  const bool is_closed = total > 0.5 && (curve(1) - curve(0)).norm() < 1e-6 * spacing(curve(0));
  // A little more than the nearest integer, so that n + 1/2 intervals round alike in both
  // directions.
  const int count = std::max(is_closed ? 3 : 1, static_cast<int>(std::floor(total + 0.5 + 1e-3)));
  std::vector<double> parameters{0.0};
  std::size_t i = 1;
  for (int node = 1; node < count; ++node) {
    const double target = total * node / count;
    while (running[i] < target) ++i;
    const double part = (target - running[i - 1]) / (running[i] - running[i - 1]);
    parameters.push_back((static_cast<double>(i - 1) + part) / samples);
  }
  parameters.push_back(1.0);
  return parameters;
}

}  // namespace strongpoint
