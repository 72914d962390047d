#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace strongpoint {

/// A uniform number in [0, 1) from the top 53 bits of the generator: the same on every platform,
/// which std::uniform_real_distribution does not promise.
inline double uniform01(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

/// Uniform numbers in [-1, 1), (size), one after the other from a generator with this seed.
inline Eigen::VectorXd random_vector(int size, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Eigen::VectorXd values(size);
  for (double& value : values) value = 2 * uniform01(generator) - 1;
  return values;
}

}  // namespace strongpoint
