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

/// The running integral of ds / h at equidistant parameters of a curve, by the trapezoidal rule
/// along chords. What is known of a curve is kept when it is refined.
template <int Dim>
class RunningIntervals {
 public:
  RunningIntervals(const Curve<Dim>& curve, const SpacingFunction<Dim>& spacing, int samples)
      : curve_(curve), spacing_(spacing), points_(samples + 1), densities_(samples + 1) {
    for (int i = 0; i <= samples; ++i) sample(i);
    integrate();
  }

  /// Intervals between samples.
  int samples() const { return static_cast<int>(points_.size()) - 1; }
  /// The integral up to a sample.
  double operator[](std::size_t sample) const { return running_[sample]; }
  double total() const { return running_.back(); }
  /// Doubles the samples.
  void refine() {
    const int coarse = samples();
    points_.resize(2 * coarse + 1);
    densities_.resize(2 * coarse + 1);
    for (int i = coarse; i > 0; --i) {
      points_[2 * i] = points_[i];
      densities_[2 * i] = densities_[i];
    }
    for (int i = 1; i < 2 * coarse; i += 2) sample(i);
    integrate();
  }

 private:
  const Curve<Dim>& curve_;
  const SpacingFunction<Dim>& spacing_;
  std::vector<Point<Dim>> points_;
  std::vector<double> densities_, running_;

  void sample(int i) {
    points_[i] = curve_(static_cast<double>(i) / samples());
    densities_[i] = 1 / checked_spacing(spacing_, points_[i]);
  }
  void integrate() {
    running_.assign(points_.size(), 0.0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      running_[i] = running_[i - 1] + 0.5 * (points_[i] - points_[i - 1]).norm() *
                                          (densities_[i] + densities_[i - 1]);
    }
  }
};

/// Gives parameters of nodes along a curve, both ends included, equidistant in the integral of ds /
/// h. The number of intervals is that integral rounded, at least 1 (3 on a closed curve).
template <int Dim>
std::vector<double> march(const Curve<Dim>& curve, const SpacingFunction<Dim>& spacing) {
  constexpr int most_samples = 1 << 16;
  constexpr double accuracy = 1e-6;  // two descriptions of a curve then place nodes alike
  constexpr int first_samples = 64;
  RunningIntervals<Dim> running(curve, spacing, first_samples);
  for (double before = -1; std::abs(running.total() - before) > accuracy * running.total() &&
                           running.samples() < most_samples;) {
    before = running.total();
    running.refine();
  }
  const double total = running.total();
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
    parameters.push_back((static_cast<double>(i - 1) + part) / running.samples());
  }
  parameters.push_back(1.0);
  return parameters;
}

}  // namespace strongpoint
