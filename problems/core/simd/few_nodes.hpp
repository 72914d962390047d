#pragma once

// For kernel sources only (methods/core/simd/path.hpp): rows of one field at so few nodes that they
// are sorted within one register.

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Nodes that one register sorts, and numbers that `FewNodes` writes; 0 where there is no such
/// register.
#if defined(__AVX512F__)
inline constexpr int few_nodes = 16;
#else
inline constexpr int few_nodes = 0;
#endif

/// Largest finite number.
inline constexpr double most = __DBL_MAX__;

/// 1 / largest magnitude, 0 where all are zero or one is not finite.
inline double scale_of(double largest, double total) {
  // A sum of magnitudes is finite when they are, but for overflow.
  const double scale = 1 / largest;
  return largest > 0 && total <= most && scale <= most ? scale : 0;
}

/// A row of one field at a few nodes, from two derivatives each.
class alignas(64) FewNodes {
#if defined(__AVX512F__)

 public:
  /// Takes 1 to `few_nodes` ids; false when one is too large for this.
  bool sort(const int* ids, int count) {
    fetch_ahead(ids);
    const auto some = static_cast<__mmask16>(0xFFFFU >> (few_nodes - count));
    const __m512i nodes = _mm512_maskz_loadu_epi32(some, ids);
    // Node and place in one number, the largest one where there is no node.
    const __m512i places = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i keys = _mm512_or_si512(_mm512_slli_epi32(nodes, place_bits), places);
    const __m512i sorted = sorted_keys(_mm512_mask_mov_epi32(_mm512_set1_epi32(-1), some, keys));
    low_ = _mm512_cvtepu32_epi64(_mm512_castsi512_si256(sorted));
    high_ = _mm512_cvtepu32_epi64(_mm512_extracti64x4_epi64(sorted, 1));
    const __m512i too_large = _mm512_set1_epi32(static_cast<int>(0xF0000000U));
    return _mm512_test_epi32_mask(nodes, too_large) == 0;
  }

  /// Adds up the entries, a pair of numbers each; the coefficients fill a pack.
  void add_up(const double* pairs, int count, const double* first, const double* second) {
    const unsigned some = 0xFFFFFFFFU >> (2 * (few_nodes - count));
    const __m512i even = _mm512_setr_epi64(0, 2, 4, 6, 8, 10, 12, 14);
    const __m512i odd = _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15);
    const Pack coefficients[2] = {all(*first), all(*second)};
#pragma GCC unroll 2
    for (int half = 0; half < 2; ++half) {
      const unsigned bits = some >> (2 * lanes * half);
      const double* const from = pairs + 2L * lanes * half;
      const Pack a = load_some(bits, from);
      const Pack b = load_some(bits >> lanes, from + lanes);
      const Pack sum = _mm512_permutex2var_pd(a, even, b) * coefficients[0];
      sums_[half] = sum + _mm512_permutex2var_pd(a, odd, b) * coefficients[1];
    }
  }

  /// The largest magnitude, 0 when an entry is not finite.
  double largest() const {
    const Pack low = abs(sums_[0]);
    const Pack high = abs(sums_[1]);
    const bool is_finite = _mm512_cmp_pd_mask(low + high, all(most), _CMP_NLE_UQ) == 0;
    return is_finite ? _mm512_reduce_max_pd(max(low, high)) : 0;
  }

  /// Writes `few_nodes` entries, scaled, and their columns, ascending.
  template <class Column>
  void put(double scale, double* values, Column* columns) const {
    static_assert(sizeof(Column) == sizeof(double), "columns fill packs as entries do");
    // Of an index the lowest four bits count: the place.
    store(values, all(scale) * _mm512_permutex2var_pd(sums_[0], low_, sums_[1]));
    store(values + lanes, all(scale) * _mm512_permutex2var_pd(sums_[0], high_, sums_[1]));
    _mm512_storeu_si512(columns, _mm512_srli_epi64(low_, place_bits));
    _mm512_storeu_si512(columns + lanes, _mm512_srli_epi64(high_, place_bits));
  }

 private:
  static constexpr int place_bits = 4;

  __m512i low_, high_;  ///< node and place, ascending
  Pack sums_[2];        ///< in the order of the stencil, 0 behind it

  /// Zeros where bits are not set. Branches are cheap, as most stencils are alike; masks are not.
  static Pack load_some(unsigned bits, const double* from) {
    fetch_ahead(from);
    if ((bits & every_lane) == every_lane) return load(from);
    return _mm512_maskz_loadu_pd(static_cast<__mmask8>(bits), from);
  }
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
#else

 public:
  // As there are never few enough, these are not called.
  static bool sort(const int*, int) { return false; }
  static void add_up(const double*, int, const double*, const double*) {}
  static double largest() { return 0; }
  template <class Column>
  static void put(double, double*, Column*) {}
#endif
};

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
