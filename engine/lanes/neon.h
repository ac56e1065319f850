/// 16 floats in four NEON registers of AArch64. `avx512.h` describes the operations; they give the same bits.
#pragma once

#include <arm_neon.h>

#include "lanes/unroll.h"

namespace hedon {
namespace {

struct Lanes {
  float32x4_t part[4];
};
struct LaneMask {
  uint32x4_t part[4];
};

/// Applies `f` to each of the four parts.
template <class F>
HEDON_INLINE Lanes each_part(const F& f) {
  return {{f(0), f(1), f(2), f(3)}};
}
template <class F>
HEDON_INLINE LaneMask each_mask(const F& f) {
  return {{f(0), f(1), f(2), f(3)}};
}

HEDON_INLINE Lanes load(const float* p) {
  return each_part([&](int i) HEDON_INLINED { return vld1q_f32(p + 4 * i); });
}
HEDON_INLINE void store(float* p, Lanes a) {
  unroll<4>([&](auto i) HEDON_INLINED { vst1q_f32(p + 4 * i, a.part[i]); });
}
HEDON_INLINE Lanes broadcast(float x) {
  const float32x4_t all = vdupq_n_f32(x);
  return {{all, all, all, all}};
}
HEDON_INLINE Lanes operator+(Lanes a, Lanes b) {
  return each_part([&](int i) HEDON_INLINED { return vaddq_f32(a.part[i], b.part[i]); });
}
HEDON_INLINE Lanes operator-(Lanes a, Lanes b) {
  return each_part([&](int i) HEDON_INLINED { return vsubq_f32(a.part[i], b.part[i]); });
}
HEDON_INLINE Lanes operator*(Lanes a, Lanes b) {
  return each_part([&](int i) HEDON_INLINED { return vmulq_f32(a.part[i], b.part[i]); });
}
HEDON_INLINE Lanes operator/(Lanes a, Lanes b) {
  return each_part([&](int i) HEDON_INLINED { return vdivq_f32(a.part[i], b.part[i]); });
}
HEDON_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
  return each_part([&](int i) HEDON_INLINED { return vfmaq_f32(c.part[i], a.part[i], b.part[i]); });
}
HEDON_INLINE Lanes square_root(Lanes a) {
  return each_part([&](int i) HEDON_INLINED { return vsqrtq_f32(a.part[i]); });
}
HEDON_INLINE LaneMask operator<(Lanes a, Lanes b) {
  return each_mask([&](int i) HEDON_INLINED { return vcltq_f32(a.part[i], b.part[i]); });
}
HEDON_INLINE LaneMask operator<=(Lanes a, Lanes b) {
  return each_mask([&](int i) HEDON_INLINED { return vcleq_f32(a.part[i], b.part[i]); });
}
HEDON_INLINE LaneMask both(LaneMask a, LaneMask b) {
  return each_mask([&](int i) HEDON_INLINED { return vandq_u32(a.part[i], b.part[i]); });
}
HEDON_INLINE bool any(LaneMask m) {
  return vmaxvq_u32(vorrq_u32(vorrq_u32(m.part[0], m.part[1]), vorrq_u32(m.part[2], m.part[3]))) != 0;
}
HEDON_INLINE uint32_t to_bits(LaneMask m) {
  // Keeps one bit in the byte of each lane, at the lane's place in its half. Then the bits of a half are added up.
  const uint16x8_t low = vcombine_u16(vmovn_u32(m.part[0]), vmovn_u32(m.part[1]));
  const uint16x8_t high = vcombine_u16(vmovn_u32(m.part[2]), vmovn_u32(m.part[3]));
  const uint8x16_t place = vreinterpretq_u8_u64(vdupq_n_u64(0x8040201008040201));
  const uint8x16_t bits = vandq_u8(vcombine_u8(vmovn_u16(low), vmovn_u16(high)), place);
  return static_cast<uint32_t>(vaddv_u8(vget_low_u8(bits))) | static_cast<uint32_t>(vaddv_u8(vget_high_u8(bits))) << 8;
}
HEDON_INLINE Lanes select(LaneMask m, Lanes yes, Lanes no) {
  return each_part([&](int i) HEDON_INLINED { return vbslq_f32(m.part[i], yes.part[i], no.part[i]); });
}
// Not NEON's own minimum and maximum, which give NaN if either is NaN.
HEDON_INLINE Lanes smaller(Lanes a, Lanes b) { return select(a < b, a, b); }
HEDON_INLINE Lanes larger(Lanes a, Lanes b) { return select(b < a, a, b); }

HEDON_INLINE Lanes scale_exponent(Lanes a, Lanes shifted) {
  return each_part([&](int i) HEDON_INLINED {
    const uint32x4_t n = vshlq_n_u32(vreinterpretq_u32_f32(shifted.part[i]), 23);
    return vreinterpretq_f32_u32(vaddq_u32(vreinterpretq_u32_f32(a.part[i]), n));
  });
}

HEDON_INLINE Lanes lower_half(Lanes a) {
  return each_part(
      [&](int i) HEDON_INLINED { return vreinterpretq_f32_u32(vshlq_n_u32(vreinterpretq_u32_f32(a.part[i]), 16)); });
}

HEDON_INLINE LaneMask first_lanes(int32_t count) {
  const int32x4_t end = vdupq_n_s32(count);
  const int32x4_t lane = vcombine_s32(vcreate_s32(0x0000000100000000), vcreate_s32(0x0000000300000002));
  return each_mask([&](int i) HEDON_INLINED { return vcltq_s32(vaddq_s32(lane, vdupq_n_s32(4 * i)), end); });
}

HEDON_INLINE int32_t write_indices(int32_t* to, int32_t first, uint32_t bits) {
  int32_t count = 0;
  for (; bits != 0; bits &= bits - 1) to[count++] = first + __builtin_ctz(bits);
  return count;
}

HEDON_INLINE float sum(Lanes a) {
  const float32x4_t four = vaddq_f32(vaddq_f32(a.part[0], a.part[2]), vaddq_f32(a.part[1], a.part[3]));
  const float32x2_t two = vadd_f32(vget_low_f32(four), vget_high_f32(four));
  return vget_lane_f32(two, 0) + vget_lane_f32(two, 1);
}

HEDON_INLINE void store_bytes(uint8_t* to, Lanes a) {
  alignas(64) float each[16];
  store(each, a);
  for (int i = 0; i < 16; ++i) to[i] = static_cast<uint8_t>(each[i]);
}

}  // namespace
}  // namespace hedon
