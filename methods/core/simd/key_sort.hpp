#pragma once

#include "methods/core/simd/key_lanes.hpp"

// For kernel sources only: sorts integer keys that lie in registers, by Batcher's bitonic merging.

namespace strongpoint::STRONGPOINT_SIMD_PATH {

#if defined(__AVX2__)

/// Orders lanes at distances `Distance`, `Distance` / 2, ..., 1 within each register.
template <int Registers, int Distance>
[[gnu::always_inline]] inline void merge_within(Keys* v) {
  if constexpr (Distance > 0) {
    for (int i = 0; i < Registers; ++i) v[i] = ordered<Distance, Distance>(v[i]);
    merge_within<Registers, Distance / 2>(v);
  }
}

/// Orders registers `Distance`, `Distance` / 2, ..., 1 apart, lane by lane.
template <int Registers, int Distance>
[[gnu::always_inline]] inline void merge_across(Keys* v) {
  if constexpr (Distance > 0) {
    for (int i = 0; i < Registers; ++i) {
      if ((i & Distance) != 0) continue;
      const Keys a = v[i];
      v[i] = lesser(a, v[i + Distance]);
      v[i + Distance] = greater(a, v[i + Distance]);
    }
    merge_across<Registers, Distance / 2>(v);
  }
}

/// Sorts runs of `Run` lanes within each register.
template <int Registers, int Run>
[[gnu::always_inline]] inline void sort_within(Keys* v) {
  if constexpr (Run > 1) {
    sort_within<Registers, Run / 2>(v);
    for (int i = 0; i < Registers; ++i) v[i] = ordered<Run - 1, Run / 2>(v[i]);
    merge_within<Registers, Run / 4>(v);
  }
}

/// Sorts runs of `Run` registers.
template <int Registers, int Run>
[[gnu::always_inline]] inline void sort_across(Keys* v) {
  if constexpr (Run > 1) {
    sort_across<Registers, Run / 2>(v);
    for (int first = 0; first < Registers; first += Run) {
      // The upper half is left in reverse: it is bitonic in either direction.
      Keys upper[Run / 2];
      for (int i = 0; i < Run / 2; ++i) {
        const Keys other = exchanged<narrow_lanes - 1>(v[first + Run - 1 - i]);
        upper[i] = greater(v[first + i], other);
        v[first + i] = lesser(v[first + i], other);
      }
      for (int i = 0; i < Run / 2; ++i) v[first + Run / 2 + i] = upper[i];
    }
    merge_across<Registers, Run / 4>(v);
    merge_within<Registers, narrow_lanes / 2>(v);
  }
}

/// Sorts the keys of some registers, ascending from lane 0 of the first register on.
template <int Registers>
[[gnu::always_inline]] inline void sort_keys(Keys* v) {
  sort_within<Registers, narrow_lanes>(v);
  sort_across<Registers, Registers>(v);
}

#else

template <int Registers>
[[gnu::always_inline]] inline void sort_keys(Keys* v) {
  for (int i = 1; i < Registers; ++i) {
    const Keys key = v[i];
    int place = i;
    for (; place > 0 && key < v[place - 1]; --place) v[place] = v[place - 1];
    v[place] = key;
  }
}

#endif

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
