/// 16 floats in two AVX2 registers. `avx512.h` describes the operations; they give the same bits.
#pragma once

#include <immintrin.h>

#include "lanes/unroll.h"

namespace hedon {
namespace {

struct Lanes {
  __m256 low, high;
};
struct LaneMask {
  __m256 low, high;
};

HEDON_INLINE Lanes load(const float* p) { return {_mm256_load_ps(p), _mm256_load_ps(p + 8)}; }
HEDON_INLINE void store(float* p, Lanes a) {
  _mm256_store_ps(p, a.low);
  _mm256_store_ps(p + 8, a.high);
}
HEDON_INLINE Lanes broadcast(float x) {
  const __m256 all = _mm256_set1_ps(x);
  return {all, all};
}
HEDON_INLINE Lanes operator+(Lanes a, Lanes b) { return {_mm256_add_ps(a.low, b.low), _mm256_add_ps(a.high, b.high)}; }
HEDON_INLINE Lanes operator-(Lanes a, Lanes b) { return {_mm256_sub_ps(a.low, b.low), _mm256_sub_ps(a.high, b.high)}; }
HEDON_INLINE Lanes operator*(Lanes a, Lanes b) { return {_mm256_mul_ps(a.low, b.low), _mm256_mul_ps(a.high, b.high)}; }
HEDON_INLINE Lanes operator/(Lanes a, Lanes b) { return {_mm256_div_ps(a.low, b.low), _mm256_div_ps(a.high, b.high)}; }
HEDON_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
  return {_mm256_fmadd_ps(a.low, b.low, c.low), _mm256_fmadd_ps(a.high, b.high, c.high)};
}
HEDON_INLINE Lanes square_root(Lanes a) { return {_mm256_sqrt_ps(a.low), _mm256_sqrt_ps(a.high)}; }
HEDON_INLINE Lanes smaller(Lanes a, Lanes b) { return {_mm256_min_ps(a.low, b.low), _mm256_min_ps(a.high, b.high)}; }
HEDON_INLINE Lanes larger(Lanes a, Lanes b) { return {_mm256_max_ps(a.low, b.low), _mm256_max_ps(a.high, b.high)}; }
HEDON_INLINE LaneMask operator<(Lanes a, Lanes b) {
  return {_mm256_cmp_ps(a.low, b.low, _CMP_LT_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_LT_OQ)};
}
HEDON_INLINE LaneMask operator<=(Lanes a, Lanes b) {
  return {_mm256_cmp_ps(a.low, b.low, _CMP_LE_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_LE_OQ)};
}
HEDON_INLINE LaneMask both(LaneMask a, LaneMask b) {
  return {_mm256_and_ps(a.low, b.low), _mm256_and_ps(a.high, b.high)};
}
HEDON_INLINE bool any(LaneMask m) { return _mm256_movemask_ps(_mm256_or_ps(m.low, m.high)) != 0; }
HEDON_INLINE uint32_t to_bits(LaneMask m) {
  return static_cast<uint32_t>(_mm256_movemask_ps(m.low)) | static_cast<uint32_t>(_mm256_movemask_ps(m.high)) << 8;
}
HEDON_INLINE Lanes select(LaneMask m, Lanes yes, Lanes no) {
  return {_mm256_blendv_ps(no.low, yes.low, m.low), _mm256_blendv_ps(no.high, yes.high, m.high)};
}

HEDON_INLINE __m256 scale_exponent_of_8(__m256 a, __m256 shifted) {
  const __m256i n = _mm256_slli_epi32(_mm256_castps_si256(shifted), 23);
  return _mm256_castsi256_ps(_mm256_add_epi32(_mm256_castps_si256(a), n));
}
HEDON_INLINE Lanes scale_exponent(Lanes a, Lanes shifted) {
  return {scale_exponent_of_8(a.low, shifted.low), scale_exponent_of_8(a.high, shifted.high)};
}

HEDON_INLINE __m256 lower_half_of_8(__m256 a) {
  return _mm256_castsi256_ps(_mm256_slli_epi32(_mm256_castps_si256(a), 16));
}
HEDON_INLINE Lanes lower_half(Lanes a) { return {lower_half_of_8(a.low), lower_half_of_8(a.high)}; }

HEDON_INLINE LaneMask first_lanes(int32_t count) {
  const __m256 lane = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256 end = _mm256_set1_ps(static_cast<float>(count));
  return {_mm256_cmp_ps(lane, end, _CMP_LT_OQ), _mm256_cmp_ps(_mm256_add_ps(lane, _mm256_set1_ps(8)), end, _CMP_LT_OQ)};
}

HEDON_INLINE int32_t write_indices(int32_t* to, int32_t first, uint32_t bits) {
  int32_t count = 0;
  for (; bits != 0; bits &= bits - 1) to[count++] = first + __builtin_ctz(bits);
  return count;
}

HEDON_INLINE float sum(Lanes a) {
  const __m256 eight = _mm256_add_ps(a.low, a.high);
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
