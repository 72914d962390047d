#pragma once

// For kernel sources only (methods/core/simd/path.hpp): the order of so few nodes that one register
// sorts them.

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Nodes that one register sorts; 0 where there is no such register.
#if defined(__AVX512F__)
inline constexpr int few_nodes = 16;
#else
inline constexpr int few_nodes = 0;
#endif

#if defined(__AVX512F__)

/// Some nodes in ascending order.
class FewOrder {
 public:
  static constexpr int place_bits = 4;

  /// Takes 1 to `few_nodes` ids; false when one is too large for this.
  bool sort(const int* ids, int count) {
    fetch_ahead(ids);
    const auto some = static_cast<__mmask16>(0xFFFFU >> (few_nodes - count));
    const __m512i nodes = _mm512_maskz_loadu_epi32(some, ids);
    const __m512i places = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i keys = _mm512_or_si512(_mm512_slli_epi32(nodes, place_bits), places);
    keys_ = sorted_keys(_mm512_mask_mov_epi32(_mm512_set1_epi32(-1), some, keys));
    const __m512i too_large = _mm512_set1_epi32(static_cast<int>(0xF0000000U));
    return _mm512_test_epi32_mask(nodes, too_large) == 0;
  }

  /// Node and, in the lowest `place_bits`, its place in the stencil; the largest number where there
  /// is no node.
  __m512i keys() const { return keys_; }

 private:
  __m512i keys_;

  /// The larger of two goes to the lanes whose bits are set.
  static __m512i ordered(__m512i a, __m512i partner, __mmask16 upper) {
    return _mm512_mask_max_epu32(_mm512_min_epu32(a, partner), upper, a, partner);
  }
  static __m512i by_one(__m512i a) {
    return ordered(a, _mm512_shuffle_epi32(a, _MM_PERM_CDAB), 0xAAAA);
  }
  static __m512i by_two(__m512i a) {
    return ordered(a, _mm512_shuffle_epi32(a, _MM_PERM_BADC), 0xCCCC);
  }
  static __m512i by_four(__m512i a) { return ordered(a, _mm512_shuffle_i64x2(a, a, 0xB1), 0xF0F0); }
  /// No branch depends on data. Source: Knuth 1998, The Art of Computer Programming 3, section
  /// 5.3.4, bitonic sorting, with the smaller one always at the lower place.
  static __m512i sorted_keys(__m512i a) {
    const __m512i eights = _mm512_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0, 15, 14, 13, 12, 11, 10, 9, 8);
    const __m512i sixteen = _mm512_setr_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    a = by_one(a);
    a = by_one(ordered(a, _mm512_shuffle_epi32(a, _MM_PERM_ABCD), 0xCCCC));
    a = by_one(by_two(ordered(a, _mm512_permutexvar_epi32(eights, a), 0xF0F0)));
    return by_one(by_two(by_four(ordered(a, _mm512_permutexvar_epi32(sixteen, a), 0xFF00))));
  }
};

#endif

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
