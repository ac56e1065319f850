/// Two weights in the bits of one float, so that agents read half as much memory when they act.
///
/// The lower 16 bits are the second weight, rounded to bfloat16. The upper 16 are chosen so that the whole float is as
/// near as possible to the first, counted in floats. So the first needs no unpacking, the second a shift. The relative
/// error of both is at most 2^-8.
#pragma once

#include <cstdint>
#include <cstring>

#include "base/device.h"

namespace hedon {

/// If either weight is NaN, with any bits, both become NaN.
HEDON_INLINE float pair_weights(float first, float second) {
  const bool known = first == first && second == second;
  uint32_t upper, lower;
  memcpy(&upper, &first, sizeof upper);
  memcpy(&lower, &second, sizeof lower);
  lower = (lower + 0x7FFFu + (lower >> 16 & 1u)) >> 16;  // ties to even
  const uint32_t sign = upper & 0x80000000u, size = (upper & 0x7FFFFFFFu) + 0x8000u;
  const uint32_t bits = known ? sign | (size > lower ? (size - lower) & 0x7FFF0000u : 0u) | lower : 0x7FC07FC0u;
  float pair;
  memcpy(&pair, &bits, sizeof pair);
  return pair;
}

}  // namespace hedon
