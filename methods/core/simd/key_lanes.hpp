#pragma once

#include "methods/core/simd/pack.hpp"

// For kernel sources only: twice as many lanes of half the width, for numbers that need not be
// exact, and for integer keys that sort them. What is appended to a list is written as a whole
// register: lists need room for `narrow_lanes` more.

namespace strongpoint::STRONGPOINT_SIMD_PATH {

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)

/// Single-precision numbers, or 32-bit keys, in a register.
inline constexpr int narrow_lanes = 16;
using Floats = __m512;
using Keys = __m512i;

inline Floats load_floats(const float* from) { return _mm512_loadu_ps(from); }
inline Keys load_keys(const int* from) { return _mm512_loadu_si512(from); }
inline Floats all_floats(float a) { return _mm512_set1_ps(a); }
inline Keys all_keys(int a) { return _mm512_set1_epi32(a); }
/// One bit a lane, set where a is at most b.
inline unsigned at_most(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
/// One bit a lane, set where a is less than b.
inline unsigned less_keys(Keys a, Keys b) { return _mm512_cmplt_epi32_mask(a, b); }
inline Keys subtract(Keys a, Keys b) { return _mm512_sub_epi32(a, b); }
/// Truncated to integers, shifted to the left, the lanes' numbers from `first` on put below.
template <int Shift>
Keys keys_of(Floats a, int first) {
  const Keys lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const Keys slot = _mm512_add_epi32(lane, _mm512_set1_epi32(first));
  return _mm512_or_si512(_mm512_slli_epi32(_mm512_cvttps_epi32(a), Shift), slot);
}
/// a in the first `count` lanes, b elsewhere.
inline Keys first_lanes(int count, Keys a, Keys b) {
  return _mm512_mask_blend_epi32(static_cast<__mmask16>((1U << count) - 1), b, a);
}
/// Entries of a table by the keys' low bits.
template <int Bits>
Keys look_up(Keys keys, const int* table) {
  const Keys slots = _mm512_and_si512(keys, _mm512_set1_epi32((1 << Bits) - 1));
  if constexpr (Bits == 5) {
    return _mm512_permutex2var_epi32(_mm512_loadu_si512(table), slots,
                                     _mm512_loadu_si512(table + 16));
  } else {
    return _mm512_i32gather_epi32(slots, table, 4);
  }
}
inline void store_keys(int* to, Keys a) { _mm512_storeu_si512(to, a); }
/// Stores the first `count` lanes alone.
inline void store_first(int* to, int count, Keys a) {
  _mm512_mask_storeu_epi32(to, static_cast<__mmask16>((1U << count) - 1), a);
}
inline int lowest(Keys a) { return _mm_cvtsi128_si32(_mm512_castsi512_si128(a)); }
/// Lanes 1 and following of a, then lane 0 of b.
inline Keys shift_in(Keys a, Keys b) { return _mm512_alignr_epi32(b, a, 1); }
/// Puts the lanes whose bits are set one after another.
inline void append_floats(float* to, Floats a, unsigned bits) {
  _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(bits), a));
}
inline void append_keys(int* to, const int* from, unsigned bits) {
  _mm512_storeu_si512(
      to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), _mm512_loadu_si512(from)));
}
/// The same from a pack, rounded, and from as many integers.
inline void append_rounded(float* to, Pack a, unsigned bits) {
  _mm256_storeu_ps(to, _mm256_maskz_compress_ps(static_cast<__mmask8>(bits), _mm512_cvtpd_ps(a)));
}
inline void append_integers(int* to, const int* from, unsigned bits) {
  const __m256i values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                      _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), values));
}
inline Keys lesser(Keys a, Keys b) { return _mm512_min_epi32(a, b); }
inline Keys greater(Keys a, Keys b) { return _mm512_max_epi32(a, b); }
/// Lane i gets lane i ^ X.
template <int X>
Keys exchanged(Keys a) {
  return _mm512_permutexvar_epi32(
      _mm512_setr_epi32(0 ^ X, 1 ^ X, 2 ^ X, 3 ^ X, 4 ^ X, 5 ^ X, 6 ^ X, 7 ^ X, 8 ^ X, 9 ^ X,
                        10 ^ X, 11 ^ X, 12 ^ X, 13 ^ X, 14 ^ X, 15 ^ X),
      a);
}
/// The greater of each pair of lanes (i, i ^ X) where i has the bit set, else the lesser.
template <int X, int Bit>
Keys ordered(Keys a) {
  constexpr unsigned upper = Bit == 1 ? 0xAAAA : Bit == 2 ? 0xCCCC : Bit == 4 ? 0xF0F0 : 0xFF00;
  const Keys other = exchanged<X>(a);
  return _mm512_mask_max_epi32(_mm512_min_epi32(a, other), static_cast<__mmask16>(upper), a, other);
}

#elif defined(__AVX2__)

inline constexpr int narrow_lanes = 8;
using Floats = __m256;
using Keys = __m256i;

/// For each set of lanes, their numbers one after another, a byte each.
struct CompressTable {
  unsigned char lane[256][8];

  constexpr CompressTable() : lane{} {
    for (int bits = 0; bits < 256; ++bits) {
      int next = 0;
      for (int i = 0; i < 8; ++i) {
        if ((bits >> i & 1) != 0) lane[bits][next++] = static_cast<unsigned char>(i);
      }
    }
  }
};
static constexpr CompressTable compress_table{};

inline Keys compress_order(unsigned bits) {
  return _mm256_cvtepu8_epi32(
      _mm_loadl_epi64(reinterpret_cast<const __m128i*>(compress_table.lane[bits])));
}

inline Floats load_floats(const float* from) { return _mm256_loadu_ps(from); }
inline Keys load_keys(const int* from) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}
inline Floats all_floats(float a) { return _mm256_set1_ps(a); }
inline Keys all_keys(int a) { return _mm256_set1_epi32(a); }
inline unsigned at_most(Floats a, Floats b) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
}
inline unsigned less_keys(Keys a, Keys b) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(b, a))));
}
inline Keys subtract(Keys a, Keys b) { return _mm256_sub_epi32(a, b); }
template <int Shift>
Keys keys_of(Floats a, int first) {
  const Keys lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const Keys slot = _mm256_add_epi32(lane, _mm256_set1_epi32(first));
  return _mm256_or_si256(_mm256_slli_epi32(_mm256_cvttps_epi32(a), Shift), slot);
}
inline Keys first_bits(int count) {
  return _mm256_cmpgt_epi32(_mm256_set1_epi32(count), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
}
inline Keys first_lanes(int count, Keys a, Keys b) {
  return _mm256_blendv_epi8(b, a, first_bits(count));
}
template <int Bits>
Keys look_up(Keys keys, const int* table) {
  if constexpr (Bits == 5) {  // a gather takes as long as eight loads and more
    const auto part = [&](int first) {
      return _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(load_keys(table + first), keys));
    };
    const __m256 by_eight = _mm256_castsi256_ps(_mm256_slli_epi32(keys, 31 - 3));
    const __m256 by_sixteen = _mm256_castsi256_ps(_mm256_slli_epi32(keys, 31 - 4));
    return _mm256_castps_si256(_mm256_blendv_ps(_mm256_blendv_ps(part(0), part(8), by_eight),
                                                _mm256_blendv_ps(part(16), part(24), by_eight),
                                                by_sixteen));
  } else {
    return _mm256_i32gather_epi32(table, _mm256_and_si256(keys, _mm256_set1_epi32((1 << Bits) - 1)),
                                  4);
  }
}
inline void store_keys(int* to, Keys a) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), a); }
inline void store_first(int* to, int count, Keys a) {
  // A masked store takes as long as ten others.
  if (count == narrow_lanes) return store_keys(to, a);
  __m128i left = _mm256_castsi256_si128(a);
  if ((count & 4) != 0) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), left);
    left = _mm256_extracti128_si256(a, 1);
    to += 4;
  }
  if ((count & 2) != 0) {
    _mm_storeu_si64(to, left);
    left = _mm_unpackhi_epi64(left, left);
    to += 2;
  }
  if ((count & 1) != 0) _mm_storeu_si32(to, left);
}
inline int lowest(Keys a) { return _mm_cvtsi128_si32(_mm256_castsi256_si128(a)); }
inline Keys shift_in(Keys a, Keys b) {
  return _mm256_permutevar8x32_epi32(_mm256_blend_epi32(a, b, 1),
                                     _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 0));
}
inline void append_floats(float* to, Floats a, unsigned bits) {
  _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(a, compress_order(bits)));
}
inline void append_keys(int* to, const int* from, unsigned bits) {
  const Keys values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  store_keys(to, _mm256_permutevar8x32_epi32(values, compress_order(bits)));
}
inline void append_rounded(float* to, Pack a, unsigned bits) {
  const Floats values = _mm256_castps128_ps256(_mm256_cvtpd_ps(a));
  _mm_storeu_ps(to, _mm256_castps256_ps128(_mm256_permutevar8x32_ps(values, compress_order(bits))));
}
inline void append_integers(int* to, const int* from, unsigned bits) {
  const Keys values =
      _mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
  _mm_storeu_si128(
      reinterpret_cast<__m128i*>(to),
      _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(values, compress_order(bits))));
}
inline Keys lesser(Keys a, Keys b) { return _mm256_min_epi32(a, b); }
inline Keys greater(Keys a, Keys b) { return _mm256_max_epi32(a, b); }
template <int X>
Keys exchanged(Keys a) {
  constexpr int near = X & 3;
  if constexpr (near != 0) {
    a = _mm256_shuffle_epi32(a, (0 ^ near) | (1 ^ near) << 2 | (2 ^ near) << 4 | (3 ^ near) << 6);
  }
  return X < 4 ? a : _mm256_permute2x128_si256(a, a, 1);
}
template <int X, int Bit>
Keys ordered(Keys a) {
  constexpr int upper = Bit == 1 ? 0xAA : Bit == 2 ? 0xCC : 0xF0;
  const Keys other = exchanged<X>(a);
  return _mm256_blend_epi32(_mm256_min_epi32(a, other), _mm256_max_epi32(a, other), upper);
}

#else

inline constexpr int narrow_lanes = 1;
using Floats = float;
using Keys = int;

inline Floats load_floats(const float* from) { return *from; }
inline Keys load_keys(const int* from) { return *from; }
inline Floats all_floats(float a) { return a; }
inline Keys all_keys(int a) { return a; }
inline unsigned at_most(Floats a, Floats b) { return a <= b ? 1 : 0; }
inline unsigned less_keys(Keys a, Keys b) { return a < b ? 1 : 0; }
inline Keys subtract(Keys a, Keys b) { return a - b; }
template <int Shift>
Keys keys_of(Floats a, int first) {
  // Lanes that are not used hold what was left there, maybe too large for an integer.
  return static_cast<int>(a < 0x1p30F ? a : 0) << Shift | first;
}
inline Keys first_lanes(int count, Keys a, Keys b) { return count > 0 ? a : b; }
template <int Bits>
Keys look_up(Keys keys, const int* table) {
  return table[keys & ((1 << Bits) - 1)];
}
inline void store_keys(int* to, Keys a) { *to = a; }
inline void store_first(int* to, int count, Keys a) {
  if (count > 0) *to = a;
}
inline int lowest(Keys a) { return a; }
inline Keys shift_in(Keys, Keys b) { return b; }
inline void append_floats(float* to, Floats a, unsigned) { *to = a; }
inline void append_keys(int* to, const int* from, unsigned) { *to = *from; }
inline void append_rounded(float* to, Pack a, unsigned) { *to = static_cast<float>(a); }
inline void append_integers(int* to, const int* from, unsigned) { *to = *from; }

#endif

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
