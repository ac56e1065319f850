/// Senses: rays, touch and the body's own state, packed into the input of the network.
///
/// The observation is a pure function of the world's state at the start of a step.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "world/food.h"
#include "world/scene.h"
#include "world/world.h"

namespace hedon {

/// The weights of the square layer that the agent in `slot` acts with.
HEDON_FN Rows square_layer(const World& world, int32_t slot) {
  const ActingNetwork network = world.network(slot);
  const int32_t at = world.shape->network.w2();
  if (network.packed_weights == nullptr) return {network.params + at, HIDDEN};
  return {network.packed_weights + at / 2, HIDDEN / 2};
}

/// The fan of the agent in `slot`, whose heading is `forward`.
HEDON_FN RayFan make_fan(const World& world, int32_t slot, Vec2 forward) {
  const SensorConfig& sensor = world.config->sensor;
  const WorldConstants& constants = *world.constants;
  RayFan fan{world.state.physics.bodies.x[slot],
             world.state.physics.bodies.y[slot],
             forward.x,
             forward.y,
             constants.ray_cosine,
             constants.ray_sine,
             sensor.ray_count,
             world.config->body.radius,
             sensor.ray_length,
             world.scene.own[slot],
             sensor.ray_inside == RayInside::behind ? -1.0f : 1.0f,
             sensor.ray_inside == RayInside::behind ? world.config->body.radius : 0.0f,
             {},
             square_layer(world, slot)};
  if (!constants.arc_convex) return fan;
  for (int32_t a = 0; a < fan.arcs(); ++a) {
    const Vec2 right = ray_direction(constants, a * 16, forward), left = ray_direction(constants, a * 16 + 15, forward);
    fan.arc[a] = {right.x, right.y, left.x, left.y};
  }
  return fan;
}

/// Casts the rays of the agent in `slot`; `rank` is that of the calling member.
HEDON_FN void cast_agent_rays(const World& world, int32_t slot, Vec2 forward, int rank, PackedObservation& out) {
  const RayTargets targets = ray_targets(world);
  const RayFan fan = make_fan(world, slot, forward);
  const Vec2 right = ray_direction(*world.constants, 0, forward);
  const Vec2 left = ray_direction(*world.constants, fan.rays - 1, forward);
  RayCandidates candidates = no_candidates(world, rank);
  find_circles(world, targets, fan, box_of(right, left, fan.start + fan.length, world.constants->fan_convex),
               candidates);
  world.kernel->cast_rays(targets, fan, candidates, out.ray, out.ray_type);
}

/// Keeps the position of an agent at the start of a step.
HEDON_FN void note_start(World& world, int32_t slot) {
  const BodyState& body = world.state.physics.bodies;
  StepScratch& scratch = world.scratch;
  sincos_float(body.angle[slot], &scratch.heading_sine[slot], &scratch.heading_cosine[slot]);
  scratch.start_angle[slot] = body.angle[slot];
  scratch.start_x[slot] = body.x[slot];
  scratch.start_y[slot] = body.y[slot];
}

/// The observation of the agent in `slot`, after `note_start`; `rank` is that of the calling member. Needs the scene.
HEDON_FN PackedObservation observe(const World& world, int32_t slot, int rank) {
  const WorldState& state = world.state;
  const BodyState& body = state.physics.bodies;
  const float sine = world.scratch.heading_sine[slot], cosine = world.scratch.heading_cosine[slot];
  PackedObservation out;
  cast_agent_rays(world, slot, {-sine, cosine}, rank, out);
  out.touch = state.touch[slot];
  const float energy = static_cast<float>(state.life[slot].energy);
  const float vx = body.velocity_x[slot], vy = body.velocity_y[slot], omega = body.angular_velocity[slot];
  if (world.config->sensor.scaling == ObservationScaling::raw) {
    const float dense[MAX_DENSE] = {vx, vy, body.angle[slot], omega, energy, 0.0f};
    for (int32_t d = 0; d < MAX_DENSE; ++d) out.dense[d] = dense[d];
  } else {
    const float dense[MAX_DENSE] = {vx / 1.5f, vy / 1.5f, sine, cosine, omega / 0.2f, energy / 100.0f};
    for (int32_t d = 0; d < MAX_DENSE; ++d) out.dense[d] = dense[d];
  }
  return out;
}

/// Sine and cosine of an angle from those of a near angle, by rotation with a short series; of a far one, directly.
HEDON_FN void turn(float sine, float cosine, float start_angle, float angle, float* out_sine, float* out_cosine) {
  const float delta = angle - start_angle;
  if (!(fabsf(delta) < 0.125f)) {
    sincos_float(angle, out_sine, out_cosine);
    return;
  }
  const float z = delta * delta;
  const float s = delta * (1.0f - z * (1.0f / 6.0f - z * (1.0f / 120.0f)));
  const float c = 1.0f - z * (0.5f - z * (1.0f / 24.0f));
  *out_sine = sine * c + cosine * s;
  *out_cosine = cosine * c - sine * s;
}

/// The visitor of the physics: notes which sectors are touched, and which food a mouth touches.
struct TouchVisitor {
  World* world;

  /// Sector of a contact in `direction` (unit, world frame) for a body at `angle`, and whether it is in the mouth.
  HEDON_FN int32_t sector(int32_t slot, Vec2 direction, float angle, bool* mouth) const {
    const StepScratch& scratch = world->scratch;
    const WorldConstants& constants = *world->constants;
    float sine, cosine;
    turn(scratch.heading_sine[slot], scratch.heading_cosine[slot], scratch.start_angle[slot], angle, &sine, &cosine);
    const float ahead = cosine * direction.y - sine * direction.x;
    const float aside = -cosine * direction.x - sine * direction.y;
    *mouth = ahead >= constants.mouth_cosine;
    const int32_t sectors = world->config->sensor.touch_sectors;
    for (int32_t s = 0; s + 1 < sectors; ++s) {
      // At or past this sector's first edge, and before its last.
      const float past_first = constants.sector_cosine[s] * aside - constants.sector_sine[s] * ahead;
      const float before_last = constants.sector_sine[s + 1] * ahead - constants.sector_cosine[s + 1] * aside;
      if (past_first >= 0.0f && before_last > 0.0f) return s;
    }
    return sectors - 1;
  }

  HEDON_FN void on_contact(PairKind kind, int32_t slot, int32_t other, Vec2 direction, float angle, uint8_t& mark) {
    bool mouth;
    const int32_t at = sector(slot, direction, angle, &mouth);
    int32_t type = AGENT_TYPE;
    if (kind == PairKind::wall) type = world->shape->wall_type();
    if (kind == PairKind::circle) {
      type = 1 + food_kind(*world->shape, other);
      if (mouth) mark = 1;
    }
    world->state.touch[slot] |= uint64_t{1} << (type * world->config->sensor.touch_sectors + at);
  }

  /// Deletes the notes about a body, before each try of a step.
  HEDON_FN void on_start(int32_t slot) { world->state.touch[slot] = 0; }
};

}  // namespace hedon
