/// Senses: rays, touch and the body's own state, packed into what the network reads.
///
/// The observation is a pure function of the world's state at the start of a step.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "world/world.h"

namespace hedon {

/// Gathers the circles that rays may hit: the living in order, then the foods present.
HEDON_FN void gather_scene(World& world) {
  Scene& scene = world.scene;
  const WorldState& state = world.state;
  int32_t n = 0;
  for (int32_t i = 0; i < world.clock().living_count; ++i, ++n) {
    const int32_t slot = state.living[i];
    scene.x[n] = state.physics.bodies.x[slot];
    scene.y[n] = state.physics.bodies.y[slot];
    scene.radius[n] = world.config->body.radius;
    scene.type[n] = AGENT_TYPE;
  }
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    for (int32_t f = world.shape->food_offset[k]; f < world.shape->food_offset[k + 1]; ++f) {
      if (!state.physics.circles.present[f]) continue;
      scene.x[n] = state.physics.circles.x[f];
      scene.y[n] = state.physics.circles.y[f];
      scene.radius[n] = world.config->body.food_radius;
      scene.type[n] = 1 + k;
      ++n;
    }
  }
  scene.count = n;
}

/// What one agent may see, relative to its center: a stack buffer for the ray kernel, cast whenever it is full.
struct Candidates {
  static constexpr int32_t CIRCLES = 512;
  static constexpr int32_t WALLS = 128;
  float x[CIRCLES], y[CIRCLES], radius[CIRCLES];
  int32_t type[CIRCLES];
  float ax[WALLS], ay[WALLS], bx[WALLS], by[WALLS];
};

/// Casts rays at the candidates gathered so far, keeps the nearer hit of each ray, and empties the buffer.
HEDON_FN void cast_candidates(const World& world, RayScene& rays, PackedObservation& out) {
  alignas(64) float reading[MAX_RAYS];
  uint8_t type[MAX_RAYS];
  world.kernel->cast_rays(rays, reading, type);
  for (int32_t r = 0; r < rays.rays; ++r) {
    if (reading[r] <= out.ray[r]) continue;
    out.ray[r] = reading[r];
    out.ray_type[r] = type[r];
  }
  rays.circles = rays.segments = 0;
}

/// True where the fan surely misses the segment from `a` to `b`, both relative to the fan's center: it lies behind an
/// edge, or even its whole line is out of reach.
HEDON_FN bool misses(const Fan& fan, Vec2 a, Vec2 b) {
  const Vec2 right{fan.right_x, fan.right_y}, left{fan.left_x, fan.left_y};
  if (cross(right, a) < 0.0f && cross(right, b) < 0.0f) return true;
  if (cross(a, left) < 0.0f && cross(b, left) < 0.0f) return true;
  const float area = cross(a, b);
  return area * area > fan.reach * fan.reach * squared_length(b - a);
}

/// Casts the rays of the agent at position `self` of the living order. `scratch` holds indices of circles.
HEDON_FN void cast_agent_rays(const World& world, int32_t self, Vec2 forward, int32_t* scratch,
                              PackedObservation& out) {
  const SensorConfig& sensor = world.config->sensor;
  const WorldConstants& constants = *world.constants;
  const Scene& scene = world.scene;
  const Vec2 center{scene.x[self], scene.y[self]};
  const Vec2 left{-forward.y, forward.x};

  alignas(64) float direction_x[MAX_RAYS], direction_y[MAX_RAYS];
  for (int32_t r = 0; r < MAX_RAYS; ++r) {
    const Vec2 direction = constants.ray_cosine[r] * forward + constants.ray_sine[r] * left;
    direction_x[r] = direction.x;
    direction_y[r] = direction.y;
    out.ray[r] = 0.0f;
    out.ray_type[r] = 0;
  }
  Fan fan{center.x, center.y, world.config->body.radius + sensor.ray_length, 0.0f, 0.0f, 0.0f, 0.0f};
  if (constants.fan_convex) {
    const int32_t last = sensor.ray_count - 1;
    fan.right_x = direction_x[0], fan.right_y = direction_y[0];
    fan.left_x = direction_x[last], fan.left_y = direction_y[last];
  }

  alignas(64) Candidates seen;
  RayScene rays{seen.x,
                seen.y,
                seen.radius,
                seen.type,
                0,
                seen.ax,
                seen.ay,
                seen.bx,
                seen.by,
                0,
                world.shape->wall_type(),
                direction_x,
                direction_y,
                sensor.ray_count,
                world.config->body.radius,
                sensor.ray_length};
  const int32_t found = world.kernel->cull_circles(fan, scene.x.data, scene.y.data, scene.radius.data,
                                                   static_cast<int32_t>(scene.count), scratch);
  for (int32_t f = 0; f < found; ++f) {
    const int32_t i = scratch[f];
    if (i == self) continue;
    if (rays.circles == Candidates::CIRCLES) cast_candidates(world, rays, out);
    const int32_t n = rays.circles++;
    seen.x[n] = scene.x[i] - center.x;
    seen.y[n] = scene.y[i] - center.y;
    seen.radius[n] = scene.radius[i];
    seen.type[n] = scene.type[i];
  }
  for (int32_t w = 0; w < world.shape->walls; ++w) {
    const Vec2 a = world.state.physics.walls[w].a - center;
    const Vec2 b = world.state.physics.walls[w].b - center;
    if (misses(fan, a, b)) continue;
    if (rays.segments == Candidates::WALLS) cast_candidates(world, rays, out);
    const int32_t n = rays.segments++;
    seen.ax[n] = a.x;
    seen.ay[n] = a.y;
    seen.bx[n] = b.x;
    seen.by[n] = b.y;
  }
  cast_candidates(world, rays, out);
}

/// Writes the observation of the agent at position `self` of the living order. `scratch`: see `cast_agent_rays`.
HEDON_FN void observe(const World& world, int32_t self, int32_t* scratch, PackedObservation& out) {
  const WorldState& state = world.state;
  const int32_t slot = state.living[self];
  const BodyState& body = state.physics.bodies;
  const float angle = body.angle[slot];
  float sine, cosine;
  sincos_float(angle, &sine, &cosine);
  cast_agent_rays(world, self, {-sine, cosine}, scratch, out);
  out.touch = state.touch[slot];
  const float energy = static_cast<float>(state.life[slot].energy);
  const float vx = body.velocity_x[slot], vy = body.velocity_y[slot], omega = body.angular_velocity[slot];
  if (world.config->sensor.scaling == ObservationScaling::raw) {
    const float dense[MAX_DENSE] = {vx, vy, angle, omega, energy, 0.0f};
    for (int32_t d = 0; d < MAX_DENSE; ++d) out.dense[d] = dense[d];
  } else {
    const float dense[MAX_DENSE] = {vx / 1.5f, vy / 1.5f, sine, cosine, omega / 0.2f, energy / 100.0f};
    for (int32_t d = 0; d < MAX_DENSE; ++d) out.dense[d] = dense[d];
  }
}

/// Sine and cosine of an angle from those of a near one, by rotation with a short series; far ones are computed anew.
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

/// What physics tells of contacts: which sectors are touched, and whether a mouth met food.
struct TouchVisitor {
  World* world;

  /// Sector of a contact in `direction` (unit, world frame) for a body at `angle`; tells also if it is in the mouth.
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
      int32_t k = 0;
      while (other >= world->shape->food_offset[k + 1]) ++k;
      type = 1 + k;
      if (mouth) mark = 1;
    }
    world->state.touch[slot] |= uint64_t{1} << (type * world->config->sensor.touch_sectors + at);
  }

  /// Forgets what was told of a body, before each try of a step.
  HEDON_FN void on_start(int32_t slot) { world->state.touch[slot] = 0; }
};

}  // namespace hedon
