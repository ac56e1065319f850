/// Loops over compile-time indices, so that arrays of lanes stay in registers.
#pragma once

#include <cstdint>

#include "base/device.h"

/// The same for lambdas; write it after their parameters.
#define HEDON_INLINED __attribute__((always_inline))

namespace hedon {
namespace {

template <int I>
struct Index {
  static constexpr int value = I;
  constexpr HEDON_INLINE operator int() const { return I; }
};

/// Calls body(Index<0>), …, body(Index<N - 1>).
template <int N, int I = 0, class Body>
HEDON_INLINE void unroll(const Body& body) {
  if constexpr (I < N) {
    body(Index<I>{});
    unroll<N, I + 1>(body);
  }
}

}  // namespace
}  // namespace hedon
