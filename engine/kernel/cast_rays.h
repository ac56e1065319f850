/// Nearest hit of an agent's rays among circles and segments. Lanes are the rays of one arc.
#pragma once

#include "kernel/ray_table.h"
#include "lanes/elementary.h"
#include "learning/network.h"

namespace hedon {
namespace {

inline constexpr float NOTHING = 3.0e38f;  ///< the distance if nothing is hit [u]
inline constexpr int32_t ROWS_PER_ARC = HIDDEN / RAY_ARCS;

/// Directions of the 16 rays of an arc, and what they have found so far.
struct RayLanes {
  Lanes direction_x, direction_y;
  Lanes distance;  ///< from the rays' start [u]; larger than any ray if nothing is hit
  Lanes type;
};

/// Rays start on the body's surface, so an object between there and the center is at distance 0.
HEDON_INLINE void take_hit(RayLanes& rays, LaneMask hit, Lanes from_center, Lanes start, Lanes length, Lanes type) {
  const Lanes distance = larger(broadcast(0.0f), from_center - start);
  const Lanes candidate = select(both(hit, distance <= length), distance, broadcast(NOTHING));
  rays.type = select(candidate < rays.distance, type, rays.type);
  rays.distance = smaller(candidate, rays.distance);
}

/// A ray misses a circle whose far side is before the ray's start, or, by the fan's `edge`, whose near side is. There
/// is no branch, because branch prediction for 16 rays would often fail. Memory is idle here, so each circle prefetches
/// a row of the data that is read `next`.
HEDON_INLINE void cast_at_circles(const RayTargets& targets, const RayFan& fan, const int32_t* circle, int32_t circles,
                                  const Rows& next, int32_t first_row, RayLanes& rays) {
  const Lanes start = broadcast(fan.start), length = broadcast(fan.length), zero = broadcast(0.0f);
  const Lanes edge = broadcast(fan.edge);
  const Lanes center_x = broadcast(fan.x), center_y = broadcast(fan.y);
  for (int32_t i = 0; i < circles; ++i) {
    const int32_t at = circle[i];
    ask_for(next.first + (first_row + i % ROWS_PER_ARC) * next.width, next.width);
    const Lanes x = broadcast(targets.circle_x[at]) - center_x;
    const Lanes y = broadcast(targets.circle_y[at]) - center_y;
    const Lanes radius = broadcast(targets.circle_radius[at]);
    const Lanes aside = rays.direction_x * y - rays.direction_y * x;
    const Lanes squared = radius * radius - aside * aside;
    const Lanes along = multiply_add(rays.direction_x, x, rays.direction_y * y);
    const Lanes half_chord = square_root(larger(zero, squared));
    const LaneMask hit = both(zero <= squared, start <= multiply_add(edge, half_chord, along));
    take_hit(rays, hit, along - half_chord, start, length, broadcast(targets.circle_type[at]));
  }
}

/// A bit mask of the 16 segments from `first` on that an arc may hit. It cannot hit a segment that is behind one of its
/// edges, or whose whole line is out of reach.
HEDON_INLINE uint32_t segments_ahead(const RayTargets& targets, const RayFan& fan, const Arc& arc, int32_t first) {
  const Lanes center_x = broadcast(fan.x), center_y = broadcast(fan.y), zero = broadcast(0.0f);
  const Lanes reach = broadcast(fan.start + fan.length);
  const Lanes ax = load(targets.segment_ax + first) - center_x, ay = load(targets.segment_ay + first) - center_y;
  const Lanes bx = load(targets.segment_bx + first) - center_x, by = load(targets.segment_by + first) - center_y;
  const Lanes right_x = broadcast(arc.right_x), right_y = broadcast(arc.right_y);
  const Lanes left_x = broadcast(arc.left_x), left_y = broadcast(arc.left_y);
  const LaneMask right_of_it = both(right_x * ay - right_y * ax < zero, right_x * by - right_y * bx < zero);
  const LaneMask left_of_it = both(ax * left_y - ay * left_x < zero, bx * left_y - by * left_x < zero);
  const Lanes area = ax * by - ay * bx, length_x = bx - ax, length_y = by - ay;
  const LaneMask beyond = reach * reach * multiply_add(length_x, length_x, length_y * length_y) < area * area;
  const int32_t count = targets.segments - first;
  const uint32_t asked = count < 16 ? (1u << count) - 1u : 0xFFFFu;
  return asked & ~(to_bits(right_of_it) | to_bits(left_of_it) | to_bits(beyond));
}

/// Segments are made longer by a millionth, so that no ray passes between two that meet.
HEDON_INLINE void cast_at_segments(const RayTargets& targets, const RayFan& fan, const Arc& arc, RayLanes& rays) {
  const Lanes start = broadcast(fan.start), length = broadcast(fan.length), nearest = broadcast(fan.nearest);
  for (int32_t first = 0; first < targets.segments; first += 16) {
    for (uint32_t bits = segments_ahead(targets, fan, arc, first); bits != 0; bits &= bits - 1) {
      const int32_t at = first + lowest_bit(bits);
      const float ax = targets.segment_ax[at] - fan.x, ay = targets.segment_ay[at] - fan.y;
      const float ex = targets.segment_bx[at] - fan.x - ax, ey = targets.segment_by[at] - fan.y - ay;
      const Lanes across = rays.direction_x * broadcast(ey) - rays.direction_y * broadcast(ex);
      const Lanes inverse = broadcast(1.0f) / across;
      const Lanes part = (broadcast(ax) * rays.direction_y - broadcast(ay) * rays.direction_x) * inverse;
      const Lanes distance = broadcast(ax * ey - ay * ex) * inverse;
      const LaneMask within = both(broadcast(-1.0e-6f) <= part, part <= broadcast(1.000001f));
      const float type = at < targets.first_obstacle ? targets.segment_type : targets.segment_type + 1.0f;
      take_hit(rays, both(within, nearest <= distance), distance, start, length, broadcast(type));
    }
  }
}

/// See `RayKernels::cast_rays`.
HEDON_FN void cast_rays(const RayTargets& targets, const RayFan& fan, const RayCandidates& candidates, float* reading,
                        uint8_t* type) {
  const Lanes forward_x = broadcast(fan.forward_x), forward_y = broadcast(fan.forward_y);
  const Lanes zero = broadcast(0.0f), length = broadcast(fan.length);
  for (int32_t a = 0; a < RAY_ARCS; ++a) {
    Lanes readings = zero, types = zero;
    if (a < fan.arcs()) {
      const Lanes cosine = load(fan.ray_cosine + a * 16), sine = load(fan.ray_sine + a * 16);
      RayLanes rays{cosine * forward_x - sine * forward_y, cosine * forward_y + sine * forward_x, broadcast(NOTHING),
                    zero};
      cast_at_circles(targets, fan, candidates.circle[a], candidates.circles[a], fan.next, a * ROWS_PER_ARC, rays);
      cast_at_segments(targets, fan, fan.arc[a], rays);
      const LaneMask found = both(rays.distance <= length, first_lanes(fan.rays - a * 16));
      readings = select(found, broadcast(2.0f) - rays.distance / length, zero);
      types = select(found, rays.type, zero);
    }
    store(reading + a * 16, readings);
    store_bytes(type + a * 16, types);
  }
}

}  // namespace
}  // namespace hedon
