/// Which circles the rays of an agent may hit. Lanes are circles.
#pragma once

#include "kernel/ray_table.h"
#include "lanes/elementary.h"

namespace hedon {
namespace {

/// See `RayKernels::cull_circles`. A circle is left out of an arc if it is out of reach or completely behind one of the
/// arc's edges. Rays may still miss a circle that is kept.
HEDON_FN void cull_circles(const RayTargets& targets, const RayFan& fan, int32_t first, int32_t last,
                           RayCandidates& candidates) {
  const Lanes center_x = broadcast(fan.x), center_y = broadcast(fan.y), reach = broadcast(fan.start + fan.length);
  const Lanes zero = broadcast(0.0f);
  const int32_t arcs = fan.arcs();
  for (int32_t block = first / 16 * 16; block < last; block += 16) {
    const Lanes to_x = load(targets.circle_x + block) - center_x;
    const Lanes to_y = load(targets.circle_y + block) - center_y;
    const Lanes radius = load(targets.circle_radius + block);
    const Lanes far = reach + radius;
    uint32_t asked = to_bits(multiply_add(to_x, to_x, to_y * to_y) <= far * far);
    if (block < first) asked &= ~0u << (first - block);
    if (last - block < 16) asked &= (1u << (last - block)) - 1u;
    const uint32_t self = static_cast<uint32_t>(fan.self - block);
    if (self < 16) asked &= ~(1u << self);
    for (int32_t a = 0; a < arcs; ++a) {
      const Arc& arc = fan.arc[a];
      const Lanes from_right = broadcast(arc.right_x) * to_y - broadcast(arc.right_y) * to_x;
      const Lanes from_left = to_x * broadcast(arc.left_y) - to_y * broadcast(arc.left_x);
      const uint32_t ahead = to_bits(both(zero <= from_right + radius, zero <= from_left + radius));
      candidates.circles[a] += write_indices(candidates.circle[a] + candidates.circles[a], block, asked & ahead);
    }
  }
}

}  // namespace
}  // namespace hedon
