#pragma once

// For kernel sources only (methods/core/simd/path.hpp).

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// The nearest bisectors found along lines or rays, one a lane, at the quotient above / below.
struct Nearest {
  Pack above, below, place;
};

/// Takes a bisector that is nearer; `its_above` is infinite where there is none.
inline void compare(Pack its_above, Pack its_below, Pack its_place, Nearest& nearest) {
  const Pack a = its_above * nearest.below;
  const Pack b = nearest.above * its_below;
  nearest.above = choose_less(a, b, its_above, nearest.above);
  nearest.below = choose_less(a, b, its_below, nearest.below);
  nearest.place = choose_less(a, b, its_place, nearest.place);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
