#pragma once

#include "methods/core/simd/pack.hpp"

// For kernel sources only: packs of either precision, for kernels that are written once for both.

namespace strongpoint::STRONGPOINT_SIMD_PATH {

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
using FloatPack = __m512;
inline FloatPack load(const float* from) { return _mm512_loadu_ps(from); }
inline void store(float* to, FloatPack a) { _mm512_storeu_ps(to, a); }
inline FloatPack all(float a) { return _mm512_set1_ps(a); }
#elif defined(__AVX2__) && defined(__FMA__)
using FloatPack = __m256;
inline FloatPack load(const float* from) { return _mm256_loadu_ps(from); }
inline void store(float* to, FloatPack a) { _mm256_storeu_ps(to, a); }
inline FloatPack all(float a) { return _mm256_set1_ps(a); }
#else
using FloatPack = float;
inline FloatPack load(const float* from) { return *from; }
inline void store(float* to, FloatPack a) { *to = a; }
inline FloatPack all(float a) { return a; }
#endif

/// The pack of a precision.
template <class Real>
struct RealPack;
template <>
struct RealPack<double> {
  using Type = Pack;
};
template <>
struct RealPack<float> {
  using Type = FloatPack;
};
template <class Real>
using PackOf = typename RealPack<Real>::Type;

/// Numbers in it.
template <class Real>
inline constexpr int width = sizeof(PackOf<Real>) / sizeof(Real);

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
