/// 16 floats for any processor, as four vectors of four, with the vector extensions of GCC and Clang.
///
/// `avx512.h` describes the operations. `multiply_add` rounds twice here: of the processors that need this file, few
/// have a fused one, and an emulation would take a hundred times as long. So bits differ from the other kernels.
#pragma once

#include "lanes/unroll.h"

namespace hedon {
namespace {

typedef float Float4 __attribute__((vector_size(16)));
typedef float StoredFloat4 __attribute__((vector_size(16), may_alias));
typedef int Int4 __attribute__((vector_size(16)));

struct Lanes {
  Float4 part[4];
};
struct LaneMask {
  Int4 part[4];
};

/// Applies `f` to each of the four parts.
template <class F>
HEDON_INLINE Lanes each_part(const F& f) {
  return {{f(0), f(1), f(2), f(3)}};
}

HEDON_INLINE Float4 broadcast4(float x) { return Float4{x, x, x, x}; }
HEDON_INLINE Lanes load(const float* p) {
  const StoredFloat4* from = reinterpret_cast<const StoredFloat4*>(p);
  return {{from[0], from[1], from[2], from[3]}};
}
HEDON_INLINE void store(float* p, Lanes a) {
  StoredFloat4* to = reinterpret_cast<StoredFloat4*>(p);
  unroll<4>([&](auto i) HEDON_INLINED { to[i] = a.part[i]; });
}
HEDON_INLINE Lanes broadcast(float x) {
  const Float4 all = broadcast4(x);
  return {{all, all, all, all}};
}
HEDON_INLINE Lanes operator+(Lanes a, Lanes b) {
  return each_part([&](int i) HEDON_INLINED { return a.part[i] + b.part[i]; });
}
HEDON_INLINE Lanes operator-(Lanes a, Lanes b) {
  return each_part([&](int i) HEDON_INLINED { return a.part[i] - b.part[i]; });
}
HEDON_INLINE Lanes operator*(Lanes a, Lanes b) {
  return each_part([&](int i) HEDON_INLINED { return a.part[i] * b.part[i]; });
}
HEDON_INLINE Lanes operator/(Lanes a, Lanes b) {
  return each_part([&](int i) HEDON_INLINED { return a.part[i] / b.part[i]; });
}
#if defined(__wasm_relaxed_simd__)
/// WebAssembly's own, which fuses if the processor can, in which case the bits match AVX2 and AVX-512.
HEDON_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
  return each_part([&](int i)
                       HEDON_INLINED { return __builtin_wasm_relaxed_madd_f32x4(a.part[i], b.part[i], c.part[i]); });
}
#else
HEDON_INLINE Lanes multiply_add(Lanes a, Lanes b, Lanes c) { return a * b + c; }
#endif
HEDON_INLINE Lanes square_root(Lanes a) {
  return each_part([&](int i) HEDON_INLINED {
    const Float4 x = a.part[i];
    return Float4{__builtin_sqrtf(x[0]), __builtin_sqrtf(x[1]), __builtin_sqrtf(x[2]), __builtin_sqrtf(x[3])};
  });
}
HEDON_INLINE LaneMask operator<(Lanes a, Lanes b) {
  return {{a.part[0] < b.part[0], a.part[1] < b.part[1], a.part[2] < b.part[2], a.part[3] < b.part[3]}};
}
HEDON_INLINE LaneMask operator<=(Lanes a, Lanes b) {
  return {{a.part[0] <= b.part[0], a.part[1] <= b.part[1], a.part[2] <= b.part[2], a.part[3] <= b.part[3]}};
}
HEDON_INLINE LaneMask both(LaneMask a, LaneMask b) {
  return {{a.part[0] & b.part[0], a.part[1] & b.part[1], a.part[2] & b.part[2], a.part[3] & b.part[3]}};
}
HEDON_INLINE bool any(LaneMask m) {
  const Int4 all = m.part[0] | m.part[1] | m.part[2] | m.part[3];
  return (all[0] | all[1] | all[2] | all[3]) != 0;
}
HEDON_INLINE uint32_t to_bits(LaneMask m) {
  uint32_t bits = 0;
  for (int i = 0; i < 16; ++i) bits |= (m.part[i / 4][i % 4] != 0 ? 1u : 0u) << i;
  return bits;
}
HEDON_INLINE Lanes select(LaneMask m, Lanes yes, Lanes no) {
  return each_part([&](int i) HEDON_INLINED {
    return reinterpret_cast<Float4>((m.part[i] & reinterpret_cast<Int4>(yes.part[i])) |
                                    (~m.part[i] & reinterpret_cast<Int4>(no.part[i])));
  });
}
HEDON_INLINE Lanes smaller(Lanes a, Lanes b) { return select(a < b, a, b); }
HEDON_INLINE Lanes larger(Lanes a, Lanes b) { return select(b < a, a, b); }

HEDON_INLINE Lanes scale_exponent(Lanes a, Lanes shifted) {
  return each_part([&](int i) HEDON_INLINED {
    return reinterpret_cast<Float4>(reinterpret_cast<Int4>(a.part[i]) +
                                    (reinterpret_cast<Int4>(shifted.part[i]) << 23));
  });
}

HEDON_INLINE Lanes lower_half(Lanes a) {
  return each_part([&](int i)
                       HEDON_INLINED { return reinterpret_cast<Float4>(reinterpret_cast<Int4>(a.part[i]) << 16); });
}

HEDON_INLINE LaneMask first_lanes(int32_t count) {
  LaneMask mask = {};
  for (int i = 0; i < 16; ++i) mask.part[i / 4][i % 4] = i < count ? -1 : 0;
  return mask;
}

HEDON_INLINE int32_t write_indices(int32_t* to, int32_t first, uint32_t bits) {
  int32_t count = 0;
  for (; bits != 0; bits &= bits - 1) to[count++] = first + __builtin_ctz(bits);
  return count;
}

HEDON_INLINE float sum(Lanes a) {
  const Float4 four = (a.part[0] + a.part[2]) + (a.part[1] + a.part[3]);
  return (four[0] + four[2]) + (four[1] + four[3]);
}

HEDON_INLINE void store_bytes(uint8_t* to, Lanes a) {
  alignas(64) float each[16];
  store(each, a);
  for (int i = 0; i < 16; ++i) to[i] = static_cast<uint8_t>(each[i]);
}

}  // namespace
}  // namespace hedon
