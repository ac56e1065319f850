/// 16 floats in one thread of a CUDA device. `avx512.h` describes the operations.
#pragma once

#include "lanes/unroll.h"

namespace hedon {
namespace {

struct Lanes {
  float v[16];
};
using LaneMask = uint32_t;

/// Applies `f` to each lane.
template <class F>
HEDON_INLINE Lanes each_lane(const F& f) {
  Lanes out;
#pragma unroll
  for (int i = 0; i < 16; ++i) out.v[i] = f(i);
  return out;
}

/// One bit for each lane where `f` holds.
template <class F>
HEDON_INLINE LaneMask mask_where(const F& f) {
  LaneMask mask = 0;
#pragma unroll
  for (int i = 0; i < 16; ++i) mask |= (f(i) ? 1u : 0u) << i;
  return mask;
}

HEDON_INLINE Lanes load(const float* p) {
  return each_lane([&](int i) { return p[i]; });
}
HEDON_INLINE void store(float* p, Lanes a) {
#pragma unroll
  for (int i = 0; i < 16; ++i) p[i] = a.v[i];
}
HEDON_INLINE Lanes broadcast(float x) {
  return each_lane([&](int) { return x; });
}
HEDON_INLINE Lanes operator+(Lanes a, Lanes b) {
  return each_lane([&](int i) { return a.v[i] + b.v[i]; });
}
HEDON_INLINE Lanes operator-(Lanes a, Lanes b) {
  return each_lane([&](int i) { return a.v[i] - b.v[i]; });
}
HEDON_INLINE Lanes operator*(Lanes a, Lanes b) {
  return each_lane([&](int i) { return a.v[i] * b.v[i]; });
}
HEDON_INLINE Lanes operator/(Lanes a, Lanes b) {
  return each_lane([&](int i) { return a.v[i] / b.v[i]; });
}
HEDON_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
  return each_lane([&](int i) { return fmaf(a.v[i], b.v[i], c.v[i]); });
}
HEDON_INLINE Lanes square_root(Lanes a) {
  return each_lane([&](int i) { return sqrtf(a.v[i]); });
}
HEDON_INLINE LaneMask operator<(Lanes a, Lanes b) {
  return mask_where([&](int i) { return a.v[i] < b.v[i]; });
}
HEDON_INLINE LaneMask operator<=(Lanes a, Lanes b) {
  return mask_where([&](int i) { return a.v[i] <= b.v[i]; });
}
HEDON_INLINE LaneMask both(LaneMask a, LaneMask b) { return a & b; }
HEDON_INLINE bool any(LaneMask m) { return m != 0; }
HEDON_INLINE uint32_t to_bits(LaneMask m) { return m; }
HEDON_INLINE Lanes select(LaneMask m, Lanes yes, Lanes no) {
  return each_lane([&](int i) { return (m >> i & 1u) != 0 ? yes.v[i] : no.v[i]; });
}
HEDON_INLINE Lanes smaller(Lanes a, Lanes b) { return select(a < b, a, b); }
HEDON_INLINE Lanes larger(Lanes a, Lanes b) { return select(b < a, a, b); }

HEDON_INLINE Lanes scale_exponent(Lanes a, Lanes shifted) {
  return each_lane([&](int i) {
    uint32_t bits, n;
    memcpy(&bits, &a.v[i], sizeof bits);
    memcpy(&n, &shifted.v[i], sizeof n);
    bits += n << 23;
    float scaled;
    memcpy(&scaled, &bits, sizeof scaled);
    return scaled;
  });
}

HEDON_INLINE Lanes lower_half(Lanes a) {
  return each_lane([&](int i) {
    uint32_t bits;
    memcpy(&bits, &a.v[i], sizeof bits);
    bits <<= 16;
    float half;
    memcpy(&half, &bits, sizeof half);
    return half;
  });
}

HEDON_INLINE LaneMask first_lanes(int32_t count) { return count >= 16 ? 0xFFFFu : (1u << count) - 1u; }

HEDON_INLINE int32_t write_indices(int32_t* to, int32_t first, uint32_t bits) {
  int32_t count = 0;
  for (int32_t i = 0; i < 16; ++i) {
    if ((bits >> i & 1u) != 0) to[count++] = first + i;
  }
  return count;
}

HEDON_INLINE float sum(Lanes a) {
  for (int half = 8; half > 0; half /= 2) {
    for (int i = 0; i < half; ++i) a.v[i] += a.v[i + half];
  }
  return a.v[0];
}

}  // namespace
}  // namespace hedon
