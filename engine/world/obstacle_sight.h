/// How rays see obstacles under `obstacle.sight = "released"`. This reproduces a fault of the sequel's released code,
/// which moves rays into the frame of a polygon with the forward instead of the inverse transform, and takes the first
/// entry instead of the last. See "Obstacles" in docs/model.md.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "base/vec2.h"
#include "world/world.h"

namespace hedon {

/// Maximum number of corners of an obstacle.
inline constexpr int32_t MAX_CORNERS = 8;

/// Whether rays see obstacles with that fault, in which case they do not meet the sides of obstacles.
HEDON_FN bool misreads_obstacles(const World& world) {
  return world.shape->obstacles > 0 && world.config->obstacle.sight == ObstacleSight::released;
}

/// One obstacle in its own frame, in which its first corner is ahead, along +y, and its sides run clockwise.
struct ObstacleFrame {
  Vec2 center;
  float cosine, sine;  ///< of the frame's angle
  float reach;         ///< of each side's line from the center [u]

  HEDON_FN Vec2 turned(Vec2 v) const { return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y}; }
};

/// per_side   distance of a side from the center, per distance of a corner
HEDON_FN ObstacleFrame frame_of(const World& world, int32_t obstacle, float per_side) {
  const int32_t corners = world.config->obstacle.corners;
  const float* const kept = &world.state.obstacle[int64_t{obstacle} * corners * 2];
  Vec2 sum{0.0f, 0.0f};
  for (int32_t c = 0; c < corners; ++c) sum = sum + Vec2{kept[2 * c], kept[2 * c + 1]};
  const Vec2 center = (1.0f / static_cast<float>(corners)) * sum;
  const Vec2 arm = Vec2{kept[0], kept[1]} - center;
  const float radius = length(arm);
  return {center, arm.y / radius, -arm.x / radius, radius * per_side};
}

/// Where a ray with the fault meets an obstacle, as a share of the ray from `start` along `way`; 2 if it does not.
HEDON_FN float misread_share(const ObstacleFrame& frame, const Vec2* normals, int32_t corners, Vec2 start, Vec2 way) {
  const Vec2 from = frame.turned(start) + frame.center, along = frame.turned(way);
  float entry = 2.0f, exit = 1.0f;
  for (int32_t c = 0; c < corners; ++c) {
    const float speed = dot(normals[c], along);
    if (speed == 0.0f) continue;
    const float at = (frame.reach - dot(normals[c], from)) / speed;
    float& bound = speed < 0.0f ? entry : exit;
    bound = at < bound ? at : bound;
  }
  return entry >= 0.0f && entry <= exit ? entry : 2.0f;
}

/// Adds obstacles seen by the rays first, first + stride … to an observation, if they are nearer than what a ray has
/// met so far. Types are still numbered as in the world.
HEDON_FN void misread_obstacles(const World& world, const Species& species, const RayFan& fan, int32_t first,
                                int32_t stride, PackedObservation& out) {
  const int32_t corners = world.config->obstacle.corners;
  const Vec2 forward{fan.forward_x, fan.forward_y}, center{fan.x, fan.y};
  double sine, cosine;
  Vec2 normals[MAX_CORNERS];
  for (int32_t c = 0; c < corners; ++c) {
    sincos_double(PI * (0.5 - (2.0 * c + 1.0) / corners), &sine, &cosine);
    normals[c] = {static_cast<float>(cosine), static_cast<float>(sine)};
  }
  sincos_double(PI / corners, &sine, &cosine);
  for (int32_t i = 0; i < world.shape->obstacles; ++i) {
    const ObstacleFrame frame = frame_of(world, i, static_cast<float>(cosine));
    for (int32_t r = first; r < fan.rays; r += stride) {
      const Vec2 direction = ray_direction(species, r, forward);
      const float share =
          misread_share(frame, normals, corners, center + fan.start * direction, fan.length * direction);
      if (share > 1.0f || 2.0f - share <= out.ray[r]) continue;
      out.ray[r] = 2.0f - share;
      out.ray_type[r] = static_cast<uint8_t>(world.shape->obstacle_type());
    }
  }
}

}  // namespace hedon
