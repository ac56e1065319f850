/// Calls the ray kernel for an agent, with the circles it may hit, the directions of its rays, and the data to
/// prefetch.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "world/obstacle_sight.h"
#include "world/scene.h"
#include "world/world.h"

namespace hedon {

/// The weights of the square layer with which the agent in `slot` acts.
HEDON_FN Rows square_layer(const World& world, int32_t slot) {
  const ActingNetwork network = world.network(slot);
  const int32_t at = world.species(slot).network.w2();
  if (network.packed_weights == nullptr) return {network.params + at, HIDDEN};
  return {network.packed_weights + at / 2, HIDDEN / 2};
}

/// The fan of the agent in `slot`, whose heading is `forward`.
HEDON_FN RayFan make_fan(const World& world, int32_t slot, Vec2 forward) {
  const Species& species = world.species(slot);
  const SensorConfig& sensor = species.config.sensor;
  const bool behind = sensor.ray_inside == SensorRayInside::behind;
  RayFan fan{world.state.physics.bodies.x[slot],
             world.state.physics.bodies.y[slot],
             forward.x,
             forward.y,
             species.ray_cosine,
             species.ray_sine,
             sensor.ray_count,
             species.body.radius,
             sensor.ray_length,
             world.scene.own[slot],
             behind ? -1.0f : 1.0f,
             behind ? species.body.radius : 0.0f,
             {},
             square_layer(world, slot)};
  if (!species.arc_convex) return fan;
  for (int32_t a = 0; a < fan.arcs(); ++a) {
    const Vec2 right = ray_direction(species, a * 16, forward), left = ray_direction(species, a * 16 + 15, forward);
    fan.arc[a] = {right.x, right.y, left.x, left.y};
  }
  return fan;
}

/// Removes the circles of types that a species does not see.
HEDON_FN void drop_unseen(const RayScene& scene, const Channels& sight, RayCandidates& candidates) {
  for (int32_t a = 0; a < RAY_ARCS; ++a) {
    int32_t kept = 0;
    for (int32_t i = 0; i < candidates.circles[a]; ++i) {
      const int32_t circle = candidates.circle[a][i];
      if (sight.of_type[static_cast<int32_t>(scene.type[circle])] >= 0) candidates.circle[a][kept++] = circle;
    }
    candidates.circles[a] = kept;
  }
}

/// Casts the rays of the agent in `slot`; `rank` is the rank of the calling member.
HEDON_FN void cast_agent_rays(const World& world, int32_t slot, Vec2 forward, int rank, PackedObservation& out) {
  const Species& species = world.species(slot);
  const RayTargets targets = ray_targets(world);
  const RayFan fan = make_fan(world, slot, forward);
  const Vec2 right = ray_direction(species, 0, forward);
  const Vec2 left = ray_direction(species, fan.rays - 1, forward);
  RayCandidates candidates = no_candidates(world, rank);
  find_circles(world.kernel->rays, world, targets, fan, box_of(right, left, fan.start + fan.length, species.fan_convex),
               candidates);
  if (!species.sight.in_order) drop_unseen(world.scene, species.sight, candidates);
  world.kernel->rays.cast_rays(targets, fan, candidates, out.ray, out.ray_type);
  if (misreads_obstacles(world)) misread_obstacles(world, species, fan, 0, 1, out);
  if (species.sight.in_order) return;
  for (int32_t r = 0; r < fan.rays; ++r) {
    // A ray that meets nothing reads 0 in the first channel.
    const bool meets = out.ray[r] > 0.0f;
    out.ray_type[r] = meets ? static_cast<uint8_t>(species.sight.of_type[out.ray_type[r]]) : uint8_t{0};
  }
}

}  // namespace hedon
