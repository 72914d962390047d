#pragma once

// For kernel sources only (methods/core/simd/path.hpp): the order of a stencil's nodes.

#include "methods/core/simd/pack.hpp"
#include "problems/core/simd/rows_kernel.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Numbers compared side by side when nodes are sorted.
inline constexpr int ranks_at_once = 16;

/// Ids that one register holds, 4 without AVX2.
inline constexpr int ids_at_once = lanes == 1 ? 4 : 2 * lanes;
using Ids = int __attribute__((vector_size(ids_at_once * sizeof(int)), may_alias));

/// Larger than any node's id.
inline constexpr int beyond = 0x7fffffff;

/// The first `count` of some ids, large numbers behind them.
inline Ids load_ids(const int* ids, int count) {
#if defined(__AVX512F__)
  const unsigned some = count >= ids_at_once ? 0xFFFFU : count > 0 ? (1U << count) - 1 : 0U;
  return reinterpret_cast<Ids>(
      _mm512_mask_loadu_epi32(_mm512_set1_epi32(beyond), static_cast<__mmask16>(some), ids));
#elif defined(__AVX2__)
  const __m256i places = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i some = _mm256_cmpgt_epi32(_mm256_set1_epi32(count), places);
  return reinterpret_cast<Ids>(
      _mm256_blendv_epi8(_mm256_set1_epi32(beyond), _mm256_maskload_epi32(ids, some), some));
#else
  Ids result;
  for (int i = 0; i < ids_at_once; ++i) result[i] = i < count ? ids[i] : beyond;
  return result;
#endif
}

/// The place of each id in ascending order: the number of smaller ones. No branch depends on data.
template <int Blocks>
void rank_few(const int* ids, int count, int* rank) {
  constexpr int packs = Blocks * ranks_at_once / ids_at_once;
  Ids numbers[packs];
  for (int b = 0; b < packs; ++b) {
    numbers[b] = load_ids(ids + b * ids_at_once, count - b * ids_at_once);
  }
  Ids smaller[packs] = {};
  for (int j = 0; j < count; ++j) {
    for (int b = 0; b < packs; ++b) smaller[b] -= numbers[b] > ids[j];  // true is -1
  }
  for (int b = 0; b < packs; ++b) reinterpret_cast<Ids*>(rank)[b] = smaller[b];
}

/// The same for 1 to `most_kernel_nodes` nodes; `rank` has room for as many.
inline void rank_nodes(const int* nodes, int count, int* rank) {
  if (count <= ranks_at_once) return rank_few<1>(nodes, count, rank);
  if (count <= 2 * ranks_at_once) return rank_few<2>(nodes, count, rank);
  rank_few<most_kernel_nodes / ranks_at_once>(nodes, count, rank);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
