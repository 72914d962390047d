#pragma once

#include <cstdint>
#include <random>

#include "methods/core/points.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {

/// Independent nodes, uniform in the unit cube, in no order.
template <int Dim>
Points<Dim> random_nodes(int count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Points<Dim> nodes(Dim, count);
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < Dim; ++c) nodes(c, i) = uniform01(generator);
  }
  return nodes;
}

}  // namespace strongpoint
