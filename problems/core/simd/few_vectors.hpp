#pragma once

// For kernel sources only (methods/core/simd/path.hpp): rows of two fields at few nodes.

#include "problems/core/simd/few_order.hpp"
#include "problems/core/simd/rows_kernel.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// The rows of a point with two fields at a few nodes. A pack holds both rows' entries at two nodes
/// in ascending order.
class alignas(64) FewVectors {
 public:
  static constexpr int fields = 2;
#if defined(__AVX512F__)

  /// Takes 1 to `few_nodes` ids; false when one is too large for this.
  bool sort(const int* ids, int count) {
    count_ = count;
    const bool is_sorted = order_.sort(ids, count);
    _mm512_store_si512(keys_, order_.keys());
    return is_sorted;
  }

  /// Adds up the entries from the weights of the stencil, `derivatives` numbers at each node, of
  /// which `used` are read. `coefficients[u]`, a pack, holds (rows, fields) twice.
  template <class Coefficients>
  void add_up(const double* weights, int derivatives, const int* used, int used_count,
              const Coefficients& coefficients) {
    largest_ = total_ = all(0);
    const int pairs = (count_ + 1) / 2;
    for (int pair = 0; pair < pairs; ++pair) {
      fetch_ahead(weights + 2L * pair * derivatives);
      const double* const low = weights + place(2 * pair) * derivatives;
      const bool is_whole = 2 * pair + 1 < count_;
      const double* const high = is_whole ? weights + place(2 * pair + 1) * derivatives : zeros;
      Pack sum = both(low + used[0], high + used[0]) * load(coefficients[0]);
      for (int u = 1; u < used_count; ++u) {
        sum = sum + both(low + used[u], high + used[u]) * load(coefficients[u]);
      }
      const Pack size = abs(sum);
      largest_ = max(size, largest_);
      total_ = total_ + size;
      sums_[pair] = sum;
    }
    sums_[pairs] = all(0);  // what is put comes in twos
  }

  /// The largest magnitudes in the rows, and sums of magnitudes.
  void measure(double* largest, double* totals) const {
    alignas(32) double high[2 * fields];
    alignas(32) double sums[2 * fields];
    _mm256_store_pd(high, _mm256_max_pd(lower(largest_), upper(largest_)));
    _mm256_store_pd(sums, _mm256_add_pd(lower(total_), upper(total_)));
    for (int row = 0; row < fields; ++row) {
      largest[row] = high[2 * row] > high[2 * row + 1] ? high[2 * row] : high[2 * row + 1];
      totals[row] = sums[2 * row] + sums[2 * row + 1];
    }
  }

  /// Writes the rows, scaled, one behind the other, and their columns, ascending; and up to
  /// 2 * `few_nodes` numbers beyond.
  template <class Column>
  void put(const double* scales, double* values, Column* columns) const {
    static_assert(sizeof(Column) == sizeof(double), "columns fill packs as entries do");
    const int quads = (count_ + 3) / 4;
    const int length = fields * count_;
    const __m512i nodes = _mm512_srli_epi32(order_.keys(), FewOrder::place_bits);
    const __m512i next = _mm512_setr_epi64(0, 1, 0, 1, 0, 1, 0, 1);
    __m512i from = _mm512_setr_epi64(0, 0, 1, 1, 2, 2, 3, 3);
    __m512i places[few_nodes / 4];
    for (int q = 0; q < quads; ++q) {
      const __m512i some = _mm512_maskz_permutexvar_epi32(0x5555, from, nodes);
      places[q] = _mm512_add_epi64(_mm512_slli_epi64(some, 1), next);
      from = _mm512_add_epi64(from, _mm512_set1_epi64(4));
    }
    for (int q = 0; q < quads; ++q) {
      store(values + q * lanes,
            all(scales[0]) * _mm512_shuffle_f64x2(sums_[2 * q], sums_[2 * q + 1], 0x88));
      _mm512_storeu_si512(columns + q * lanes, places[q]);
    }
    for (int q = 0; q < quads; ++q) {
      store(values + length + q * lanes,
            all(scales[1]) * _mm512_shuffle_f64x2(sums_[2 * q], sums_[2 * q + 1], 0xDD));
      _mm512_storeu_si512(columns + length + q * lanes, places[q]);
    }
  }

 private:
  static constexpr double zeros[most_kernel_derivatives] = {};

  alignas(64) int keys_[few_nodes];
  FewOrder order_;
  Pack sums_[few_nodes / 2 + 1];
  Pack largest_, total_;
  int count_;

  int place(int i) const { return keys_[i] & (few_nodes - 1); }
  /// One number in the lower half, another in the upper one.
  static Pack both(const double* low, const double* high) {
    return _mm512_mask_broadcastsd_pd(all(*low), 0xF0, _mm_load_sd(high));
  }
  static __m256d lower(Pack a) { return _mm512_castpd512_pd256(a); }
  static __m256d upper(Pack a) { return _mm512_extractf64x4_pd(a, 1); }
#else

  // As there are never few enough, these are not called.
  static bool sort(const int*, int) { return false; }
  template <class Coefficients>
  static void add_up(const double*, int, const int*, int, const Coefficients&) {}
  static void measure(double*, double*) {}
  template <class Column>
  static void put(const double*, double*, Column*) {}
#endif
};

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
