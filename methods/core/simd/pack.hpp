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

#elif defined(__AVX2__)

inline constexpr int lanes = 4;
using Pack = __m256d;

inline Pack load(const double* from) { return _mm256_loadu_pd(from); }
inline void store(double* to, Pack a) { _mm256_storeu_pd(to, a); }
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

#else

inline constexpr int lanes = 1;
using Pack = double;

inline Pack load(const double* from) { return *from; }
inline void store(double* to, Pack a) { *to = a; }
inline Pack all(double a) { return a; }
inline Pack sqrt(Pack a) { return __builtin_sqrt(a); }
inline Pack abs(Pack a) { return __builtin_fabs(a); }
inline Pack min(Pack a, Pack b) { return a < b ? a : b; }
inline Pack max(Pack a, Pack b) { return a > b ? a : b; }
inline unsigned less(Pack a, Pack b) { return a < b ? 1 : 0; }
inline Pack choose(unsigned bits, Pack a, Pack b) { return bits != 0 ? a : b; }

#endif

/// All lanes' bits.
inline constexpr unsigned every_lane = (1U << lanes) - 1;

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
