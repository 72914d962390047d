#pragma once

// For kernel sources only (methods/core/simd/path.hpp): rows of one field at few nodes.

#include "problems/core/simd/few_order.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

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
    FewOrder order;
    const bool is_sorted = order.sort(ids, count);
    low_ = _mm512_cvtepu32_epi64(_mm512_castsi512_si256(order.keys()));
    high_ = _mm512_cvtepu32_epi64(_mm512_extracti64x4_epi64(order.keys(), 1));
    return is_sorted;
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
  static constexpr int place_bits = FewOrder::place_bits;

  __m512i low_, high_;  ///< node and place, ascending
  Pack sums_[2];        ///< in the order of the stencil, 0 behind it

  /// Zeros where bits are not set. Branches are cheap, as most stencils are alike; masks are not.
  static Pack load_some(unsigned bits, const double* from) {
    fetch_ahead(from);
    if ((bits & every_lane) == every_lane) return load(from);
    return _mm512_maskz_loadu_pd(static_cast<__mmask8>(bits), from);
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
