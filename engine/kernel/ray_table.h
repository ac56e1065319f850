/// The kernels of rays.
#pragma once

#include <cstdint>

#include "learning/observation.h"

namespace hedon {

/// Circles and segments that rays may hit. Arrays are aligned to 64 bytes and readable to the next multiple of 16.
struct RayTargets {
  const float* circle_x;  ///< [u]
  const float* circle_y;
  const float* circle_radius;
  const float* circle_type;  ///< small integers, as floats
  const float* segment_ax;   ///< ends [u]
  const float* segment_ay;
  const float* segment_bx;
  const float* segment_by;
  int32_t segments;
  int32_t first_obstacle;  ///< segments from here on are sides of obstacles, whose type is the next one
  float segment_type;      ///< of the others
};

/// HIDDEN rows of floats, one after another.
struct Rows {
  const float* first;
  int32_t width;
};

inline constexpr int RAY_ARCS = PACKED_RAYS / 16;

/// The sector of the plane that 16 neighboring rays can reach: directions of its edges, 0 if it is not convex.
struct Arc {
  float right_x, right_y, left_x, left_y;
};

/// The rays of one agent, from the right to the left.
struct RayFan {
  float x, y;                  ///< the agent's center [u]
  float forward_x, forward_y;  ///< its heading, a unit vector
  const float* ray_cosine;     ///< of each ray's angle to the heading; (32), entries past `rays` repeat the last
  const float* ray_sine;
  int32_t rays;
  float start;    ///< distance from the center at which rays start: the body's radius [u]
  float length;   ///< of a ray, from its start [u]
  int32_t self;   ///< index of the agent's own circle, which its rays ignore; -1 if it has none
  float edge;     ///< 1: a circle is hit if its far edge is past the start of the ray; -1: only if its near edge is
  float nearest;  ///< distance from the center at which segments begin to be hit: 0, or `start` [u]
  Arc arc[RAY_ARCS];
  Rows next;  ///< data that is read after the rays are cast, prefetched meanwhile, one row per circle

  HEDON_INLINE int32_t arcs() const { return (rays + 15) / 16; }
};

/// Indices of the circles that the rays of each arc may hit. Each list has room for all circles and 16 more.
struct RayCandidates {
  int32_t* circle[RAY_ARCS];
  int32_t circles[RAY_ARCS];
};

struct RayKernels {
  /// Appends the circles of [first, last) that each arc may touch, in order. No ray can hit the others.
  void (*cull_circles)(const RayTargets& targets, const RayFan& fan, int32_t first, int32_t last,
                       RayCandidates& candidates);

  /// Nearest hit of each ray among the candidates circles and all segments: `reading` = 2 - d / length (that is, the
  /// observed reading + 1) and `type`; both are 0 if nothing is hit. Both have PACKED_RAYS entries, 0 past the fan's
  /// rays; `reading` is aligned to 64 bytes. Of equal distances the first counts, circles before segments.
  void (*cast_rays)(const RayTargets& targets, const RayFan& fan, const RayCandidates& candidates, float* reading,
                    uint8_t* type);
};

}  // namespace hedon
