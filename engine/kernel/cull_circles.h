/// Which circles the rays of an agent may hit. Lanes are circles.
#pragma once

#include "kernel/kernel.h"
#include "lanes/elementary.h"

namespace hedon {
namespace {

/// See `Kernel::cull_circles`. A circle is left out of an arc if it is out of reach or completely behind one of the
/// arc's edges. Rays may still miss a circle that is kept.
HEDON_FN void cull_circles(const RayScene& scene, const Eye& eye, int32_t first, int32_t last, Sighted& sighted) {
  const Lanes eye_x = broadcast(eye.x), eye_y = broadcast(eye.y), reach = broadcast(eye.start + eye.length);
  const Lanes zero = broadcast(0.0f);
  const int32_t arcs = eye.arcs();
  for (int32_t block = first / 16 * 16; block < last; block += 16) {
    const Lanes to_x = load(scene.circle_x + block) - eye_x;
    const Lanes to_y = load(scene.circle_y + block) - eye_y;
    const Lanes radius = load(scene.circle_radius + block);
    const Lanes far = reach + radius;
    uint32_t asked = to_bits(multiply_add(to_x, to_x, to_y * to_y) <= far * far);
    if (block < first) asked &= ~0u << (first - block);
    if (last - block < 16) asked &= (1u << (last - block)) - 1u;
    const uint32_t self = static_cast<uint32_t>(eye.self - block);
    if (self < 16) asked &= ~(1u << self);
    for (int32_t a = 0; a < arcs; ++a) {
      const Arc& arc = eye.arc[a];
      const Lanes from_right = broadcast(arc.right_x) * to_y - broadcast(arc.right_y) * to_x;
      const Lanes from_left = to_x * broadcast(arc.left_y) - to_y * broadcast(arc.left_x);
      const uint32_t ahead = to_bits(both(zero <= from_right + radius, zero <= from_left + radius));
      sighted.circles[a] += write_indices(sighted.circle[a] + sighted.circles[a], block, asked & ahead);
    }
  }
}

}  // namespace
}  // namespace hedon
