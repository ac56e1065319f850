/// Which circles a fan of rays may touch. Lanes are circles.
#pragma once

#include "kernel/kernel.h"
#include "lanes/elementary.h"

namespace hedon {
namespace {

/// See `Kernel::cull_circles`. A circle is left out where it lies beyond the rays' reach or wholly behind one of the
/// fan's edges; what is kept may still be missed by every ray.
int32_t cull_circles(const Fan& fan, const float* x, const float* y, const float* radius, int32_t count,
                     int32_t* found) {
  const Lanes center_x = broadcast(fan.x), center_y = broadcast(fan.y), reach = broadcast(fan.reach);
  const Lanes right_x = broadcast(fan.right_x), right_y = broadcast(fan.right_y);
  const Lanes left_x = broadcast(fan.left_x), left_y = broadcast(fan.left_y);
  const Lanes zero = broadcast(0.0f);
  int32_t n = 0;
  for (int32_t first = 0; first < count; first += 16) {
    const Lanes to_x = load(x + first) - center_x;
    const Lanes to_y = load(y + first) - center_y;
    const Lanes r = load(radius + first);
    const Lanes far = reach + r;
    const Lanes from_right = right_x * to_y - right_y * to_x;
    const Lanes from_left = to_x * left_y - to_y * left_x;
    const LaneMask near = multiply_add(to_x, to_x, to_y * to_y) <= far * far;
    const LaneMask ahead = both(zero <= from_right + r, zero <= from_left + r);
    uint32_t bits = to_bits(both(near, ahead));
    if (count - first < 16) bits &= (1u << (count - first)) - 1u;
    for (; bits != 0; bits &= bits - 1) found[n++] = first + __builtin_ctz(bits);
  }
  return n;
}

}  // namespace
}  // namespace hedon
