/// Senses: rays, touch and the body's own state, packed into the input of the network.
///
/// The observation is a pure function of the world's state at the start of a step.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "world/channel.h"
#include "world/food.h"
#include "world/ray.h"
#include "world/smell.h"
#include "world/world.h"

namespace hedon {

/// Stores the position of an agent at the start of a step.
HEDON_FN void note_start(World& world, int32_t slot) {
  const BodyState& body = world.state.physics.bodies;
  StepScratch& scratch = world.scratch;
  sincos_float(body.angle[slot], &scratch.heading_sine[slot], &scratch.heading_cosine[slot]);
  scratch.start_angle[slot] = body.angle[slot];
  scratch.start_x[slot] = body.x[slot];
  scratch.start_y[slot] = body.y[slot];
}

/// The heading of the agent in `slot` at the start of the step, a unit vector.
HEDON_FN Vec2 forward_of(const World& world, int32_t slot) {
  return {-world.scratch.heading_sine[slot], world.scratch.heading_cosine[slot]};
}

/// Writes the part of an observation that needs no rays: touch, and channels.
HEDON_FN void sense_body(const World& world, int32_t slot, PackedObservation& out) {
  const Species& species = world.species(slot);
  const FixedList<Channel, MAX_CHANNELS>& observed = species.layout.observed;
  out.touch = world.state.touch[slot];
  if (species.network.observation.wide()) extra_of(out).touch = world.state.touch_more[slot];
  if (species.layout.smells.count > 0) smell(world, slot, forward_of(world, slot));
  if (species.layout.neighbors.count > 0) look_around(world, slot, forward_of(world, slot));
  for (int32_t d = observed.count; d < MAX_DENSE; ++d) out.dense[d] = 0.0f;
  for (int32_t d = 0; d < observed.count; ++d) set_dense(out, d, read_channel(world, slot, out, observed[d]));
}

/// Writes the observation of the agent in `slot`, after `note_start`; `rank` is the rank of the calling member. Needs
/// the scene.
HEDON_FN void observe(const World& world, int32_t slot, int rank, PackedObservation& out) {
  cast_agent_rays(world, slot, forward_of(world, slot), rank, out);
  sense_body(world, slot, out);
}

/// Sine and cosine of an angle: by rotation of a known pair with a short series if the angles are close, else directly.
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

/// The visitor of the physics: records which sectors are touched, and which food a mouth touches.
struct TouchVisitor {
  World* world;

  /// Sector of a contact in `direction` (unit, world frame) for a body at `angle`, and whether it is in the mouth.
  HEDON_FN int32_t sector(const Species& species, int32_t slot, Vec2 direction, float angle, bool* mouth) const {
    const StepScratch& scratch = world->scratch;
    float sine, cosine;
    turn(scratch.heading_sine[slot], scratch.heading_cosine[slot], scratch.start_angle[slot], angle, &sine, &cosine);
    const float ahead = cosine * direction.y - sine * direction.x;
    const float aside = -cosine * direction.x - sine * direction.y;
    *mouth = species.mouth_center.x * ahead + species.mouth_center.y * aside >= species.mouth_cosine;
    const int32_t sectors = species.config.sensor.touch_sectors;
    for (int32_t s = 0; s + 1 < sectors; ++s) {
      // At or past this sector's first edge, and before its last.
      const float past_first = species.sector_cosine[s] * aside - species.sector_sine[s] * ahead;
      const float before_last = species.sector_sine[s + 1] * ahead - species.sector_cosine[s + 1] * aside;
      if (past_first >= 0.0f && before_last > 0.0f) return s;
    }
    return sectors - 1;
  }

  template <class Crew>
  HEDON_FN void on_contact(const Crew& crew, PairKind kind, int32_t slot, int32_t other, Vec2 direction, float angle,
                           uint8_t bit, uint8_t& mark) {
    const WorldShape& shape = *world->shape;
    const Species& species = world->species(slot);
    bool mouth;
    const int32_t at = sector(species, slot, direction, angle, &mouth);
    int32_t type = shape.type_of_wall(other);
    if (kind == PairKind::body) type = shape.species_of(other);
    if (kind == PairKind::circle) type = shape.food_type(food_kind(shape, other));
    const bool hurts = type == shape.obstacle_type();
    if (hurts || (mouth && eats(species, type))) mark |= bit;
    const int32_t touched = species.touch.of_type[type] * species.config.sensor.touch_sectors + at;
    if (touched < 64)
      crew.set_bits(world->state.touch[slot], uint64_t{1} << touched);
    else
      crew.set_bits(world->state.touch_more[slot], uint64_t{1} << (touched - 64));
  }

  /// Discards the records about a body, before each try of a step.
  HEDON_FN void on_start(int32_t slot) {
    world->state.touch[slot] = 0;
    if (world->state.touch_more.count > 0) world->state.touch_more[slot] = 0;
  }

  HEDON_FN bool eats(const Species& species, int32_t type) const {
    const WorldShape& shape = *world->shape;
    if (type < shape.species) return shape.hunting && species.layout.eats_species[type] > 0.0f;
    return type < shape.wall_type() && species.layout.eats_food[type - shape.species] != 0.0f;
  }
};

}  // namespace hedon
