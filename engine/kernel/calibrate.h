/// Rates of multiply-adds in registers and of reads: the peak rates that other kernels are compared with.
#pragma once

#include <cstdint>

#include "lanes/unroll.h"

namespace hedon {
namespace {

/// See `RateKernels::multiply_adds`. As many independent chains as fit the registers, so that latency does not matter.
template <class Shape>
HEDON_FN int64_t multiply_adds(int64_t rounds, float* result) {
  constexpr int chains = Shape::chains;
  // All different, since the compiler would compute equal lanes only once.
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

/// See `RateKernels::sum_floats`. Four partial sums, so that additions do not wait for one another.
HEDON_FN float sum_floats(const float* values, int64_t count) {
  constexpr int sums = 4, stride = sums * 16;
  Lanes total[sums];
  unroll<sums>([&](auto i) HEDON_INLINED { total[i] = broadcast(0.0f); });
  for (int64_t at = 0; at < count; at += stride) {
    unroll<sums>([&](auto i) HEDON_INLINED { total[i] = total[i] + load(values + at + i * 16); });
  }
  unroll<sums - 1>([&](auto i) HEDON_INLINED { total[0] = total[0] + total[i + 1]; });
  return sum(total[0]);
}

}  // namespace
}  // namespace hedon
