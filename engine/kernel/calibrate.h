/// Rate of multiply-adds in registers: the ceiling that the other kernels are measured against.
#pragma once

#include <cstdint>

#include "lanes/unroll.h"

namespace hedon {
namespace {

/// See `Kernel::multiply_adds`. As many independent chains as fit the registers, so that latency does not count.
template <class Shape>
HEDON_FN int64_t multiply_adds(int64_t rounds, float* result) {
  constexpr int chains = Shape::chains;
  // All different: equal lanes would be computed once.
  alignas(64) float first[chains * 16];
  for (int i = 0; i < chains * 16; ++i) first[i] = static_cast<float>(i) * *result;
  Lanes total[chains];
  unroll<chains>([&](auto i) HEDON_INLINED { total[i] = load(first + i * 16); });
  const Lanes factor = broadcast(*result);
  for (int64_t i = 0; i < rounds; ++i) {
    unroll<chains>([&](auto c) HEDON_INLINED { total[c] = multiply_add(total[c], factor, factor); });
  }
  unroll<chains - 1>([&](auto i) HEDON_INLINED { total[0] = total[0] + total[i + 1]; });
  *result = sum(total[0]);
  return rounds * chains * 16 * 2;
}

}  // namespace
}  // namespace hedon
