#pragma once

// For kernel sources only (methods/core/simd/path.hpp): numbers side by side, one lane each. What
// is here is named by the path that the source is compiled for; a pack of the scalar path is a
// double, so that one source serves all paths. The operators + - * / work on packs as they do on
// numbers.

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define STRONGPOINT_SIMD_PATH avx512
#elif defined(__AVX2__) && defined(__FMA__)
#define STRONGPOINT_SIMD_PATH avx2
#else
#define STRONGPOINT_SIMD_PATH scalar
#endif

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace strongpoint::STRONGPOINT_SIMD_PATH {

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)

/// Numbers in a pack.
inline constexpr int lanes = 8;
using Pack = __m512d;

inline Pack load(const double* from) { return _mm512_loadu_pd(from); }
inline void store(double* to, Pack a) { _mm512_storeu_pd(to, a); }
/// Stores past the caches, to a place that begins a pack; `end_streams` comes before others read.
inline void stream(double* to, Pack a) { _mm512_stream_pd(to, a); }
inline void end_streams() { _mm_sfence(); }
inline Pack all(double a) { return _mm512_set1_pd(a); }
inline Pack sqrt(Pack a) { return _mm512_sqrt_pd(a); }
inline Pack abs(Pack a) { return _mm512_abs_pd(a); }
inline Pack min(Pack a, Pack b) { return _mm512_min_pd(a, b); }
inline Pack max(Pack a, Pack b) { return _mm512_max_pd(a, b); }
/// One bit a lane, set where a is less than b.
inline unsigned less(Pack a, Pack b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
/// a where the lane's bit is set, b elsewhere.
inline Pack choose(unsigned bits, Pack a, Pack b) {
  return _mm512_mask_blend_pd(static_cast<__mmask8>(bits), b, a);
}
/// x where a is less than b, y elsewhere.
inline Pack choose_less(Pack a, Pack b, Pack x, Pack y) { return choose(less(a, b), x, y); }

/// Nodes of all lanes side by side: `to[c]` gets coordinate c of node[0], node[1], ...
template <int Dim>
[[gnu::always_inline]] inline void load_nodes(const double* const* node, Pack* to) {
  // Masked broadcasts from memory: shuffles are scarcer than loads.
  if constexpr (Dim >= 2) {
    Pack even = _mm512_castpd128_pd512(_mm_loadu_pd(node[0]));
    even = _mm512_mask_broadcast_f64x2(even, 0x0C, _mm_loadu_pd(node[2]));
    even = _mm512_mask_broadcast_f64x2(even, 0x30, _mm_loadu_pd(node[4]));
    even = _mm512_mask_broadcast_f64x2(even, 0xC0, _mm_loadu_pd(node[6]));
    Pack odd = _mm512_castpd128_pd512(_mm_loadu_pd(node[1]));
    odd = _mm512_mask_broadcast_f64x2(odd, 0x0C, _mm_loadu_pd(node[3]));
    odd = _mm512_mask_broadcast_f64x2(odd, 0x30, _mm_loadu_pd(node[5]));
    odd = _mm512_mask_broadcast_f64x2(odd, 0xC0, _mm_loadu_pd(node[7]));
    to[0] = _mm512_unpacklo_pd(even, odd);
    to[1] = _mm512_unpackhi_pd(even, odd);
  }
  if constexpr (Dim != 2) {
    constexpr int c = Dim - 1;
    Pack half[2];  // two chains
    for (int h = 0; h < 2; ++h) {
      half[h] = all(node[4 * h][c]);
      for (int lane = 4 * h + 1; lane < 4 * h + 4; ++lane) {
        half[h] = _mm512_mask_broadcastsd_pd(half[h], static_cast<__mmask8>(1U << lane),
                                             _mm_load_sd(node[lane] + c));
      }
    }
    to[c] = _mm512_mask_blend_pd(0xF0, half[0], half[1]);
  }
}

/// Eight numbers of each of eight packs become eight numbers of each lane.
inline void transpose(const Pack* from, Pack* to) {
  for (int odd = 0; odd < 2; ++odd) {
    Pack pairs[4];  // of lanes odd, odd + 2, odd + 4, odd + 6
    for (int i = 0; i < 4; ++i) {
      pairs[i] = odd == 0 ? _mm512_unpacklo_pd(from[2 * i], from[2 * i + 1])
                          : _mm512_unpackhi_pd(from[2 * i], from[2 * i + 1]);
    }
    const Pack outer = _mm512_shuffle_f64x2(pairs[0], pairs[1], 0x88);
    const Pack inner = _mm512_shuffle_f64x2(pairs[0], pairs[1], 0xDD);
    const Pack outer2 = _mm512_shuffle_f64x2(pairs[2], pairs[3], 0x88);
    const Pack inner2 = _mm512_shuffle_f64x2(pairs[2], pairs[3], 0xDD);
    to[odd] = _mm512_shuffle_f64x2(outer, outer2, 0x88);
    to[odd + 2] = _mm512_shuffle_f64x2(inner, inner2, 0x88);
    to[odd + 4] = _mm512_shuffle_f64x2(outer, outer2, 0xDD);
    to[odd + 6] = _mm512_shuffle_f64x2(inner, inner2, 0xDD);
  }
}

#elif defined(__AVX2__)

inline constexpr int lanes = 4;
using Pack = __m256d;

inline Pack load(const double* from) { return _mm256_loadu_pd(from); }
inline void store(double* to, Pack a) { _mm256_storeu_pd(to, a); }
inline void stream(double* to, Pack a) { _mm256_stream_pd(to, a); }
inline void end_streams() { _mm_sfence(); }
inline Pack all(double a) { return _mm256_set1_pd(a); }
inline Pack sqrt(Pack a) { return _mm256_sqrt_pd(a); }
inline Pack abs(Pack a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
inline Pack min(Pack a, Pack b) { return _mm256_min_pd(a, b); }
inline Pack max(Pack a, Pack b) { return _mm256_max_pd(a, b); }
inline unsigned less(Pack a, Pack b) {
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_LT_OQ)));
}
inline Pack choose(unsigned bits, Pack a, Pack b) {
  const __m256i lane_bits = _mm256_set_epi64x(8, 4, 2, 1);
  const __m256i chosen = _mm256_and_si256(_mm256_set1_epi64x(bits), lane_bits);
  return _mm256_blendv_pd(b, a, _mm256_castsi256_pd(_mm256_cmpeq_epi64(chosen, lane_bits)));
}
inline Pack choose_less(Pack a, Pack b, Pack x, Pack y) {
  return _mm256_blendv_pd(y, x, _mm256_cmp_pd(a, b, _CMP_LT_OQ));  // without the detour over bits
}

/// Nodes of all lanes side by side: `to[c]` gets coordinate c of node[0], node[1], ...
template <int Dim>
[[gnu::always_inline]] inline void load_nodes(const double* const* node, Pack* to) {
  if constexpr (Dim >= 2) {
    const Pack even = _mm256_set_m128d(_mm_loadu_pd(node[2]), _mm_loadu_pd(node[0]));
    const Pack odd = _mm256_set_m128d(_mm_loadu_pd(node[3]), _mm_loadu_pd(node[1]));
    to[0] = _mm256_unpacklo_pd(even, odd);
    to[1] = _mm256_unpackhi_pd(even, odd);
  }
  if constexpr (Dim != 2) {
    constexpr int c = Dim - 1;
    to[c] = _mm256_set_pd(node[3][c], node[2][c], node[1][c], node[0][c]);
  }
}

/// Four numbers of each of four packs become four numbers of each lane.
inline void transpose(const Pack* from, Pack* to) {
  const Pack low = _mm256_unpacklo_pd(from[0], from[1]);
  const Pack high = _mm256_unpackhi_pd(from[0], from[1]);
  const Pack low2 = _mm256_unpacklo_pd(from[2], from[3]);
  const Pack high2 = _mm256_unpackhi_pd(from[2], from[3]);
  to[0] = _mm256_permute2f128_pd(low, low2, 0x20);
  to[1] = _mm256_permute2f128_pd(high, high2, 0x20);
  to[2] = _mm256_permute2f128_pd(low, low2, 0x31);
  to[3] = _mm256_permute2f128_pd(high, high2, 0x31);
}

#else

inline constexpr int lanes = 1;
using Pack = double;

inline Pack load(const double* from) { return *from; }
inline void store(double* to, Pack a) { *to = a; }
inline void stream(double* to, Pack a) { *to = a; }
inline void end_streams() {}
inline Pack all(double a) { return a; }
inline Pack sqrt(Pack a) { return __builtin_sqrt(a); }
inline Pack abs(Pack a) { return __builtin_fabs(a); }
inline Pack min(Pack a, Pack b) { return a < b ? a : b; }
inline Pack max(Pack a, Pack b) { return a > b ? a : b; }
inline unsigned less(Pack a, Pack b) { return a < b ? 1 : 0; }
inline Pack choose(unsigned bits, Pack a, Pack b) { return bits != 0 ? a : b; }
inline Pack choose_less(Pack a, Pack b, Pack x, Pack y) { return a < b ? x : y; }
template <int Dim>
[[gnu::always_inline]] inline void load_nodes(const double* const* node, Pack* to) {
  for (int c = 0; c < Dim; ++c) to[c] = node[0][c];
}
inline void transpose(const Pack* from, Pack* to) { *to = *from; }

#endif

/// Asks for what soon comes of an array that is read once, from its beginning to its end; beyond
/// it nothing happens.
inline void fetch_ahead(const void* now) {
  constexpr long bytes_ahead = 2048;
  __builtin_prefetch(static_cast<const char*>(now) + bytes_ahead);
}

/// All lanes' bits.
inline constexpr unsigned every_lane = (1U << lanes) - 1;

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
