/// Two weights in the bits of one float, so that agents read half as much memory when they act.
///
/// The lower 16 bits are the second weight, rounded to bfloat16. The upper 16 are chosen so that the float as a whole
/// lies next to the first, counted in floats: so the first needs no unpacking, the second a shift. Both are off by at
/// most 2^-8 of themselves.
#pragma once

#include <cstdint>
#include <cstring>

#include "base/device.h"

namespace hedon {

/// Where either is NaN both are, whatever its bits.
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
