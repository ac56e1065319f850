/// 16 floats over the 16 threads of a tile: each holds one lane. `lanes/avx512.h` describes the operations.
///
/// All threads of a tile call these functions together. So the kernels of the CPU run here unchanged: each thread loads
/// and stores its own lane, and broadcast numbers are the same in all threads.
#pragma once

#include <cstring>

#include "cuda/thread.h"
#include "lanes/unroll.h"

namespace hedon {
namespace {

struct Lanes {
  float v;
};
struct LaneMask {
  bool v;
};

HEDON_INLINE Lanes load(const float* p) { return {p[thread_lane()]}; }
HEDON_INLINE void store(float* p, Lanes a) { p[thread_lane()] = a.v; }
HEDON_INLINE void store_bytes(uint8_t* to, Lanes a) { to[thread_lane()] = static_cast<uint8_t>(a.v); }
HEDON_INLINE Lanes broadcast(float x) { return {x}; }
HEDON_INLINE Lanes operator+(Lanes a, Lanes b) { return {a.v + b.v}; }
HEDON_INLINE Lanes operator-(Lanes a, Lanes b) { return {a.v - b.v}; }
HEDON_INLINE Lanes operator*(Lanes a, Lanes b) { return {a.v * b.v}; }
HEDON_INLINE Lanes operator/(Lanes a, Lanes b) { return {a.v / b.v}; }
HEDON_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) { return {__builtin_fmaf(a.v, b.v, c.v)}; }
HEDON_INLINE Lanes square_root(Lanes a) { return {__builtin_sqrtf(a.v)}; }
HEDON_INLINE LaneMask operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
HEDON_INLINE LaneMask operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
HEDON_INLINE LaneMask both(LaneMask a, LaneMask b) { return {a.v && b.v}; }
HEDON_INLINE uint32_t to_bits(LaneMask m) { return tile_ballot(m.v); }
HEDON_INLINE Lanes select(LaneMask m, Lanes yes, Lanes no) { return m.v ? yes : no; }
HEDON_INLINE Lanes smaller(Lanes a, Lanes b) { return select(a < b, a, b); }
HEDON_INLINE Lanes larger(Lanes a, Lanes b) { return select(b < a, a, b); }

HEDON_INLINE Lanes scale_exponent(Lanes a, Lanes shifted) {
  uint32_t bits, n;
  memcpy(&bits, &a.v, sizeof bits);
  memcpy(&n, &shifted.v, sizeof n);
  bits += n << 23;
  memcpy(&a.v, &bits, sizeof bits);
  return a;
}

HEDON_INLINE Lanes lower_half(Lanes a) {
  uint32_t bits;
  memcpy(&bits, &a.v, sizeof bits);
  bits <<= 16;
  memcpy(&a.v, &bits, sizeof bits);
  return a;
}

HEDON_INLINE LaneMask first_lanes(int32_t count) { return {thread_lane() < count}; }

HEDON_INLINE int32_t write_indices(int32_t* to, int32_t first, uint32_t bits) {
  const int lane = thread_lane();
  if ((bits >> lane & 1u) != 0) to[count_bits(bits & ((1u << lane) - 1u))] = first + lane;
  return count_bits(bits);
}

/// In the order of the other lane types: halves onto halves.
HEDON_INLINE float sum(Lanes a) {
  const int lane = thread_lane();
  for (int half = TILE / 2; half > 0; half /= 2) a.v += tile_read(a.v, (lane + half) % TILE);
  return tile_read(a.v, 0);
}

}  // namespace
}  // namespace hedon
