#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "methods/core/points.hpp"

namespace strongpoint {

/// A direction that waves run along.
template <int Dim>
struct Direction {
  Point<Dim> unit;   ///< of length 1
  std::string text;  ///< see `direction_text`
};

/// The direction of a wave vector in degrees: 2D from the x axis, at least 0 and below 180; 3D the
/// same in the xy plane, a colon, and the angle above it; 1D 0. The reverse of a vector, whose
/// waves have the same speeds, has the same text.
template <int Dim>
std::string direction_text(const Point<Dim>& xi) {
  if constexpr (Dim == 1) return "0";
  constexpr double degree = std::numbers::pi / 180;
  const auto rounded = [](double angle) { return std::round(angle / degree * 1e6) / 1e6 + 0.0; };
  if constexpr (Dim == 2) {
    const double angle = rounded(std::atan2(xi[1], xi[0]));
    return fmt::format("{:.6g}", angle < 0 ? angle + 180 : angle == 180 ? 0 : angle);
  }
  if constexpr (Dim == 3) {
    const double level = std::hypot(xi[0], xi[1]);
    constexpr double round_off = 1e-9;
    if (level < round_off * std::abs(xi[2])) return "0:90";
    double azimuth = rounded(std::atan2(xi[1], xi[0]));
    double elevation = rounded(std::atan2(xi[2], level));
    if (azimuth < 0 || azimuth == 180) {
      azimuth += azimuth < 0 ? 180 : -180;
      elevation = 0.0 - elevation;
    }
    return fmt::format("{:.6g}:{:.6g}", azimuth, elevation);
  }
}

/// Directions at all multiples of a half-turn over `angles`: 2D on a half circle, `angles` of them;
/// 3D on a half sphere, by both angles, 1 + angles (angles - 1); 1D the only one.
template <int Dim>
std::vector<Direction<Dim>> directions_of(int angles) {
  std::vector<Point<Dim>> units;
  const double step = std::numbers::pi / angles;
  if constexpr (Dim == 1) units.push_back(Point<1>(1.0));
  if constexpr (Dim == 2) {
    for (int k = 0; k < angles; ++k) units.emplace_back(std::cos(k * step), std::sin(k * step));
  }
  if constexpr (Dim == 3) {
    units.emplace_back(0, 0, 1);
    for (int m = 1; m < angles; ++m) {
      const double elevation = m * step - std::numbers::pi / 2;
      for (int k = 0; k < angles; ++k) {
        units.emplace_back(std::cos(elevation) * std::cos(k * step),
                           std::cos(elevation) * std::sin(k * step), std::sin(elevation));
      }
    }
  }
  std::vector<Direction<Dim>> all;
  all.reserve(units.size());
  for (const Point<Dim>& unit : units) all.push_back({unit, direction_text<Dim>(unit)});
  return all;
}

/// Calls `visit(xi)` for wave vectors on a lattice over half of |xi_c| h <= pi, which has all
/// eigenvalues or their conjugates.
template <int Dim, class Visit>
void for_each_wave_vector(double spacing, Visit&& visit) {
  constexpr int steps = Dim == 1 ? 1000 : Dim == 2 ? 32 : 12;
  constexpr int side = 2 * steps + 1;
  int count = steps + 1;
  for (int c = 1; c < Dim; ++c) count *= side;
  for (int i = 0; i < count; ++i) {
    Point<Dim> xi;
    int rest = i;
    for (int c = Dim - 1; c > 0; --c, rest /= side) xi[c] = rest % side - steps;
    xi[0] = rest;
    visit((xi * (std::numbers::pi / (steps * spacing))).eval());
  }
}

}  // namespace strongpoint
