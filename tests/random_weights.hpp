#pragma once

#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "methods/core/method.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {

/// Stencils of random nodes at each of some points, with random weights.
inline Weights random_weights(int nodes, int per_row, int per_entry) {
  std::mt19937_64 generator(1);
  Weights weights;
  weights.per_entry = per_entry;
  std::vector<int> all(nodes);
  std::iota(all.begin(), all.end(), 0);
  for (int p = 0; p < nodes; ++p) {
    for (int j = 0; j < per_row; ++j) {  // the first of a shuffled list
      const auto left = static_cast<double>(nodes - j);
      std::swap(all[j], all[j + static_cast<int>(uniform01(generator) * left)]);
      weights.columns.push_back(all[j]);
    }
    weights.offsets.push_back(static_cast<std::int64_t>(weights.columns.size()));
  }
  for (int e = 0; e < nodes * per_row * per_entry; ++e) {
    weights.values.push_back(2 * uniform01(generator) - 1);
  }
  return weights;
}

}  // namespace strongpoint
