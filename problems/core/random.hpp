#pragma once

#include <random>

namespace strongpoint {

/// A uniform number in [0, 1) from the top 53 bits of the generator: the same on every platform,
/// which std::uniform_real_distribution does not promise.
inline double uniform01(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

}  // namespace strongpoint
