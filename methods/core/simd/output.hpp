#pragma once

#include <cstddef>

namespace strongpoint {

/// How kernels store results.
enum class Output {
  cached,
  streamed  ///< past the caches: a line that is not read before it is written takes half the time
};

/// Numbers of eight bytes from which on an array is streamed: so many would not stay in a cache.
inline constexpr std::size_t least_streamed = std::size_t{1} << 21;

}  // namespace strongpoint
