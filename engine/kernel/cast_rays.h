/// Nearest hit of a fan of rays among circles and segments. Lanes are rays.
#pragma once

#include "kernel/kernel.h"
#include "lanes/elementary.h"

namespace hedon {
namespace {

inline constexpr int RAY_LANES = PACKED_RAYS / 16;

/// What 16 rays have found so far.
struct NearestHit {
  Lanes distance;  ///< from the rays' start [u]; larger than any ray where nothing is hit
  Lanes type;
};

/// Rays start on the body's surface, so what lies between there and the center is at distance 0.
HEDON_INLINE void take_hit(NearestHit& nearest, LaneMask hit, Lanes from_center, Lanes start, Lanes length, Lanes type) {
  const Lanes distance = larger(broadcast(0.0f), from_center - start);
  const LaneMask nearer = both(both(hit, distance <= length), distance < nearest.distance);
  nearest.distance = select(nearer, distance, nearest.distance);
  nearest.type = select(nearer, type, nearest.type);
}

/// See `Kernel::cast_rays`. A ray misses a circle whose far side lies before the ray's start. Ties go to the first,
/// circles before segments. Segments count as longer by a millionth, so that no ray slips through where two meet.
void cast_rays(const RayScene& scene, float* reading, uint8_t* type) {
  const Lanes start = broadcast(scene.start);
  const Lanes length = broadcast(scene.length);
  const Lanes zero = broadcast(0.0f);
  for (int half = 0; half < RAY_LANES; ++half) {
    const Lanes direction_x = load(scene.direction_x + half * 16);
    const Lanes direction_y = load(scene.direction_y + half * 16);
    NearestHit nearest = {broadcast(3.0e38f), zero};
    if (half * 16 < scene.rays) {
      for (int32_t i = 0; i < scene.circles; ++i) {
        const Lanes x = broadcast(scene.circle_x[i]);
        const Lanes y = broadcast(scene.circle_y[i]);
        const Lanes aside = direction_x * y - direction_y * x;
        const Lanes squared = broadcast(scene.circle_radius[i] * scene.circle_radius[i]) - aside * aside;
        const LaneMask crossed = zero <= squared;
        if (!any(crossed)) continue;
        const Lanes along = multiply_add(direction_x, x, direction_y * y);
        const Lanes reach = square_root(larger(zero, squared));
        take_hit(nearest, both(crossed, start <= along + reach), along - reach, start, length,
                 broadcast(static_cast<float>(scene.circle_type[i])));
      }
      const Lanes wall = broadcast(static_cast<float>(scene.wall_type));
      for (int32_t i = 0; i < scene.segments; ++i) {
        const float ax = scene.segment_ax[i];
        const float ay = scene.segment_ay[i];
        const float ex = scene.segment_bx[i] - ax;
        const float ey = scene.segment_by[i] - ay;
        const Lanes across = direction_x * broadcast(ey) - direction_y * broadcast(ex);
        const Lanes part = (broadcast(ax) * direction_y - broadcast(ay) * direction_x) / across;
        const Lanes distance = broadcast(ax * ey - ay * ex) / across;
        const LaneMask within = both(broadcast(-1.0e-6f) <= part, part <= broadcast(1.000001f));
        take_hit(nearest, both(within, zero <= distance), distance, start, length, wall);
      }
    }
    const LaneMask found = nearest.distance <= length;
    alignas(64) float types[16];
    store(types, select(found, nearest.type, zero));
    alignas(64) float readings[16];
    store(readings, select(found, broadcast(2.0f) - nearest.distance / length, zero));
    for (int r = 0; r < 16; ++r) {
      const bool used = half * 16 + r < scene.rays;
      reading[half * 16 + r] = used ? readings[r] : 0.0f;
      type[half * 16 + r] = used ? static_cast<uint8_t>(types[r]) : uint8_t{0};
    }
  }
}

}  // namespace
}  // namespace hedon
