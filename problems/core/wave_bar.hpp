#pragma once

#include <cmath>
#include <numbers>

namespace strongpoint {

/// A pulse of force at the free end of a bar that is clamped at x = 0, F(t) = F0 exp(-b (t - t0)^2)
/// for t > 0, and the waves it makes in a bar of length 1 at rest, where the force is EA u' and
/// EA = 1. Source: d'Alembert's solution of thesis (4.23) with its reflections: u = f(c t + x) -
/// f(c t - x) with f'(s) = F((s - 1) / c) - f'(s - 2).
struct BarPulse {
  double force;      ///< F0
  double b;          ///< 1 over time squared
  double t0;         ///< time of the peak
  double speed = 1;  ///< c

  /// F(t) / F0, without the start at t = 0, before which it is next to nothing.
  double shape(double t) const { return std::exp(-b * (t - t0) * (t - t0)); }

  /// u(x, t).
  double displacement(double x, double t) const {
    return force * (travelled(speed * t + x) - travelled(speed * t - x));
  }
  /// u'(x, t), the force at a section.
  double section_force(double x, double t) const {
    return force * (slope(speed * t + x) + slope(speed * t - x));
  }

 private:
  /// f / F0: reflections at distances 1, 3, 5, ... with alternating signs.
  double travelled(double s) const {
    double sum = 0;
    double sign = 1;
    for (double way = s - 1; way > 0; way -= 2, sign = -sign) sum += sign * impulse(way / speed);
    return speed * sum;
  }
  double slope(double s) const {
    double sum = 0;
    double sign = 1;
    for (double way = s - 1; way > 0; way -= 2, sign = -sign) sum += sign * shape(way / speed);
    return sum;
  }
  /// Integral of the shape from 0 to t.
  double impulse(double t) const {
    const double root = std::sqrt(b);
    return std::sqrt(std::numbers::pi) / (2 * root) *
           (std::erf(root * (t - t0)) + std::erf(root * t0));
  }
};

}  // namespace strongpoint
