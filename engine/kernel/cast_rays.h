/// Nearest hit of a fan of rays among circles and segments. Lanes are rays.
#pragma once

#include "kernel/kernel.h"
#include "lanes/elementary.h"

namespace hedon {
namespace {

inline constexpr int RAY_LANES = PACKED_RAYS / 16;
inline constexpr float NOTHING = 3.0e38f;  ///< the distance [u] of what was not hit

/// What 16 rays have found so far.
struct NearestHit {
  Lanes distance;  ///< from the rays' start [u]; larger than any ray where nothing is hit
  Lanes type;
};

/// Rays start on the body's surface, so what lies between there and the center is at distance 0.
HEDON_INLINE void take_hit(NearestHit& nearest, LaneMask hit, Lanes from_center, Lanes start, Lanes length, Lanes type) {
  const Lanes distance = larger(broadcast(0.0f), from_center - start);
  const Lanes candidate = select(both(hit, distance <= length), distance, broadcast(NOTHING));
  nearest.type = select(candidate < nearest.distance, type, nearest.type);
  nearest.distance = smaller(candidate, nearest.distance);
}

/// See `Kernel::cast_rays`. A ray misses a circle whose far side lies before the ray's start. Ties go to the first,
/// circles before segments. Segments count as longer by a millionth, so that no ray slips through where two meet.
void cast_rays(const RayScene& scene, float* reading, uint8_t* type) {
  const Lanes start = broadcast(scene.start);
  const Lanes length = broadcast(scene.length);
  const Lanes zero = broadcast(0.0f);
  Lanes direction_x[RAY_LANES];
  Lanes direction_y[RAY_LANES];
  NearestHit nearest[RAY_LANES];
  unroll<RAY_LANES>([&](auto h) HEDON_INLINED {
    direction_x[h] = load(scene.direction_x + h * 16);
    direction_y[h] = load(scene.direction_y + h * 16);
    nearest[h] = {broadcast(NOTHING), zero};
  });

  for (int32_t i = 0; i < scene.circles; ++i) {
    const Lanes x = broadcast(scene.circle_x[i]);
    const Lanes y = broadcast(scene.circle_y[i]);
    const Lanes radius_squared = broadcast(scene.circle_radius[i] * scene.circle_radius[i]);
    const Lanes kind = broadcast(static_cast<float>(scene.circle_type[i]));
    unroll<RAY_LANES>([&](auto h) HEDON_INLINED {
      const Lanes aside = direction_x[h] * y - direction_y[h] * x;
      const Lanes squared = radius_squared - aside * aside;
      const LaneMask crossed = zero <= squared;
      if (any(crossed)) {
        const Lanes along = multiply_add(direction_x[h], x, direction_y[h] * y);
        const Lanes reach = square_root(larger(zero, squared));
        take_hit(nearest[h], both(crossed, start <= along + reach), along - reach, start, length, kind);
      }
    });
  }

  const Lanes wall = broadcast(static_cast<float>(scene.wall_type));
  for (int32_t i = 0; i < scene.segments; ++i) {
    const float ax = scene.segment_ax[i];
    const float ay = scene.segment_ay[i];
    const float ex = scene.segment_bx[i] - ax;
    const float ey = scene.segment_by[i] - ay;
    unroll<RAY_LANES>([&](auto h) HEDON_INLINED {
      const Lanes across = direction_x[h] * broadcast(ey) - direction_y[h] * broadcast(ex);
      const Lanes inverse = broadcast(1.0f) / across;
      const Lanes part = (broadcast(ax) * direction_y[h] - broadcast(ay) * direction_x[h]) * inverse;
      const Lanes distance = broadcast(ax * ey - ay * ex) * inverse;
      const LaneMask within = both(broadcast(-1.0e-6f) <= part, part <= broadcast(1.000001f));
      take_hit(nearest[h], both(within, zero <= distance), distance, start, length, wall);
    });
  }

  unroll<RAY_LANES>([&](auto h) HEDON_INLINED {
    const LaneMask found = nearest[h].distance <= length;
    alignas(64) float types[16];
    alignas(64) float readings[16];
    store(types, select(found, nearest[h].type, zero));
    store(readings, select(found, broadcast(2.0f) - nearest[h].distance / length, zero));
    for (int r = 0; r < 16; ++r) {
      const bool used = h * 16 + r < scene.rays;
      reading[h * 16 + r] = used ? readings[r] : 0.0f;
      type[h * 16 + r] = used ? static_cast<uint8_t>(types[r]) : uint8_t{0};
    }
  });
}

}  // namespace
}  // namespace hedon
