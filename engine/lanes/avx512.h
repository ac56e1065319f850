/// 16 floats in one AVX-512 register. Included by one unit only, which is compiled for that instruction set.
///
/// The operations, the same in each file of this folder: `load` and `store` need 64-byte alignment; `multiply_add(a, b,
/// c)` is a*b + c, rounded once; `smaller` and `larger` give b where either is NaN; comparisons with NaN are false;
/// `sum` adds in a fixed tree (halves of 8, 4, 2, 1); `to_bits` gives one bit per lane, the first the lowest.
#pragma once

// GCC before 13 warns about the undefined operands inside its own AVX-512 header (GCC bug 105593).
#if defined(__GNUC__) && !defined(__clang__) && __GNUC__ < 13
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>

#include "lanes/unroll.h"

namespace hedon {
namespace {

struct Lanes {
  __m512 v;
};
using LaneMask = __mmask16;

HEDON_INLINE Lanes load(const float* p) { return {_mm512_load_ps(p)}; }
HEDON_INLINE void store(float* p, Lanes a) { _mm512_store_ps(p, a.v); }
HEDON_INLINE Lanes broadcast(float x) { return {_mm512_set1_ps(x)}; }
HEDON_INLINE Lanes operator+(Lanes a, Lanes b) { return {_mm512_add_ps(a.v, b.v)}; }
HEDON_INLINE Lanes operator-(Lanes a, Lanes b) { return {_mm512_sub_ps(a.v, b.v)}; }
HEDON_INLINE Lanes operator*(Lanes a, Lanes b) { return {_mm512_mul_ps(a.v, b.v)}; }
HEDON_INLINE Lanes operator/(Lanes a, Lanes b) { return {_mm512_div_ps(a.v, b.v)}; }
HEDON_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) { return {_mm512_fmadd_ps(a.v, b.v, c.v)}; }
HEDON_INLINE Lanes square_root(Lanes a) { return {_mm512_sqrt_ps(a.v)}; }
HEDON_INLINE Lanes smaller(Lanes a, Lanes b) { return {_mm512_min_ps(a.v, b.v)}; }
HEDON_INLINE Lanes larger(Lanes a, Lanes b) { return {_mm512_max_ps(a.v, b.v)}; }
HEDON_INLINE LaneMask operator<(Lanes a, Lanes b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ); }
HEDON_INLINE LaneMask operator<=(Lanes a, Lanes b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ); }
HEDON_INLINE LaneMask both(LaneMask a, LaneMask b) { return static_cast<LaneMask>(a & b); }
HEDON_INLINE bool any(LaneMask m) { return m != 0; }
HEDON_INLINE uint32_t to_bits(LaneMask m) { return m; }
HEDON_INLINE Lanes select(LaneMask m, Lanes yes, Lanes no) { return {_mm512_mask_blend_ps(m, no.v, yes.v)}; }

/// a * 2^n, where n is the integer in the low bits of `shifted` = n + 1.5 * 2^23.
HEDON_INLINE Lanes scale_exponent(Lanes a, Lanes shifted) {
  const __m512i n = _mm512_slli_epi32(_mm512_castps_si512(shifted.v), 23);
  return {_mm512_castsi512_ps(_mm512_add_epi32(_mm512_castps_si512(a.v), n))};
}

/// The lower 16 bits of each lane as the upper bits of a float: see `learning/weight_pair.h`.
HEDON_INLINE Lanes lower_half(Lanes a) {
  return {_mm512_castsi512_ps(_mm512_slli_epi32(_mm512_castps_si512(a.v), 16))};
}

/// The lanes before `count`.
HEDON_INLINE LaneMask first_lanes(int32_t count) {
  return count >= 16 ? LaneMask{0xFFFF} : static_cast<LaneMask>((1u << count) - 1u);
}

/// Writes first + i for each bit i that is set, in order; returns how many. May write up to 16 numbers.
HEDON_INLINE int32_t write_indices(int32_t* to, int32_t first, uint32_t bits) {
  const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512i index = _mm512_add_epi32(_mm512_set1_epi32(first), lane);
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), index));
  return __builtin_popcount(bits);
}

HEDON_INLINE float sum(Lanes a) {
  const __m256 eight = _mm256_add_ps(_mm512_castps512_ps256(a.v), _mm512_extractf32x8_ps(a.v, 1));
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
}

HEDON_INLINE void store_bytes(uint8_t* to, Lanes a) {
  alignas(64) float each[16];
  store(each, a);
  for (int i = 0; i < 16; ++i) to[i] = static_cast<uint8_t>(each[i]);
}

}  // namespace
}  // namespace hedon
