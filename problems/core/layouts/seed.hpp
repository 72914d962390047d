#pragma once

#include <limits>

#include "problems/core/layout.hpp"

namespace strongpoint {

/// The seed a random layout uses: its option `seed`, or the request's when the spec gives none.
inline std::uint64_t seed_of(const Options& options, const LayoutRequest& request) {
  if (!options.has("seed")) return request.seed;
  return static_cast<std::uint64_t>(options.integer("seed", 0, std::numeric_limits<int>::max()));
}

/// Documents the option `seed` of a random layout.
inline OptionDoc seed_option() {
  return {"seed", "", "of the random numbers; the study's --seed when left out"};
}

}  // namespace strongpoint
