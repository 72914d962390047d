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
  /// Sum of a function of the time since each reflection, with alternating signs; the wave has gone
  /// distances of 1, 3, 5, ... when it is reflected.
  template <class Function>
  double over_reflections(double s, const Function& function) const {
    double sum = 0;
    for (int n = 0; s - 1 - 2 * n > 0; ++n) {
      sum += (n % 2 == 0 ? 1 : -1) * function((s - 1 - 2 * n) / speed);
    }
    return sum;
  }
  /// f / F0.
  double travelled(double s) const {
    return speed * over_reflections(s, [this](double t) { return impulse(t); });
  }
  /// f' / F0.
  double slope(double s) const {
    return over_reflections(s, [this](double t) { return shape(t); });
  }
  /// Integral of the shape from 0 to t.
  double impulse(double t) const {
    const double root = std::sqrt(b);
    return std::sqrt(std::numbers::pi) / (2 * root) *
           (std::erf(root * (t - t0)) + std::erf(root * t0));
  }
};

}  // namespace strongpoint
