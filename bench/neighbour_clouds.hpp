#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>

#include "methods/core/hilbert.hpp"
#include "methods/core/neighbours.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {

/// Distributions of nodes over which neighbour searches are timed.
enum class Crowd {
  lattice,    ///< a cubic one: most distances tie
  perturbed,  ///< each node of it moved by up to 0.3 spacings along each axis
  random,     ///< independent and uniform in the unit cube
  graded      ///< between the radii 0.001 and 1: directions and logarithms of radii are uniform, so
              ///< that the spacing grows with the radius, 1000 times in all
};

inline std::string_view name_of(Crowd crowd) {
  constexpr std::string_view names[] = {"lattice", "perturbed", "random", "graded"};
  return names[static_cast<int>(crowd)];
}

/// A direction, uniform on the circle or sphere, by rejection.
template <int Dim>
Point<Dim> random_direction(std::mt19937_64& generator) {
  while (true) {
    Point<Dim> x;
    for (int c = 0; c < Dim; ++c) x[c] = 2 * uniform01(generator) - 1;
    const double length = x.norm();
    if (length <= 1 && length > 0.01) return x / length;
  }
}

/// About `count` nodes, sorted along a Hilbert curve.
template <int Dim>
Points<Dim> sorted_crowd(Crowd crowd, int count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const int side = static_cast<int>(std::lround(std::pow(count, 1.0 / Dim)));
  if (crowd == Crowd::lattice || crowd == Crowd::perturbed) {
    count = static_cast<int>(std::lround(std::pow(side, Dim)));
  }
  const double amount = crowd == Crowd::perturbed ? 0.3 : 0;
  Points<Dim> nodes(Dim, count);
  for (int i = 0; i < count; ++i) {
    if (crowd == Crowd::graded) {
      nodes.col(i) = std::pow(10.0, -3 * uniform01(generator)) * random_direction<Dim>(generator);
      continue;
    }
    for (int c = 0, rest = i; c < Dim; ++c, rest /= side) {
      const double u = uniform01(generator);
      nodes(c, i) = crowd == Crowd::random ? u : (rest % side + amount * (2 * u - 1)) / (side - 1);
    }
  }
  return columns_of<Dim>(nodes, hilbert_order<Dim>(nodes));
}

}  // namespace strongpoint
