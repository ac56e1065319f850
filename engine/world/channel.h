/// Reads channels: numbers that can be known of an agent in a step. `hedon.config.channel` says what each source is.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/vec2.h"
#include "world/world.h"

namespace hedon {

/// Mean reading of all rays of the agent in `slot` in this step, 0 for those that met nothing.
HEDON_FN float nearness(const World& world, int32_t slot) {
  const PackedObservation& seen = world.observation(slot, world.kept(slot, world.window_step()));
  const int32_t rays = world.species(slot).config->sensor.ray_count;
  float sum = 0.0f;
  for (int32_t r = 0; r < rays; ++r) sum += seen.ray[r] > 0.0f ? seen.ray[r] - 1.0f : 0.0f;
  return sum / static_cast<float>(rays);
}

/// The number that a channel has of the agent in `slot`, before it is scaled.
HEDON_FN double channel_value(const World& world, int32_t slot, const Channel& channel) {
  const WorldState& state = world.state;
  const StepScratch& scratch = world.scratch;
  const BodyState& body = state.physics.bodies;
  const int32_t i = channel.index;
  switch (channel.source) {
    case ChannelSource::velocity:
      return static_cast<double>(i == 0 ? body.velocity_x[slot] : body.velocity_y[slot]);
    case ChannelSource::angle:
      return static_cast<double>(body.angle[slot]);
    case ChannelSource::heading:
      return static_cast<double>(i == 0 ? scratch.heading_sine[slot] : scratch.heading_cosine[slot]);
    case ChannelSource::angular_velocity:
      return static_cast<double>(body.angular_velocity[slot]);
    case ChannelSource::store:
      return world.held(slot, i);
    case ChannelSource::store_before:
      return world.held_before(slot)[i];
    case ChannelSource::smell:
      return static_cast<double>(scratch.smelled[int64_t{slot} * world.shape->scents + i]);
    case ChannelSource::age:
      return static_cast<double>(world.head().step + 1 - state.life[slot].birth_step);
    case ChannelSource::moved:
      return static_cast<double>(
          length(Vec2{body.x[slot] - scratch.start_x[slot], body.y[slot] - scratch.start_y[slot]}));
    case ChannelSource::nearness:
      return static_cast<double>(nearness(world, slot));
    case ChannelSource::force:
      return static_cast<double>(i == 0 ? scratch.force_left[slot] : scratch.force_right[slot]);
    case ChannelSource::position:
      return static_cast<double>(i == 0 ? body.x[slot] : body.y[slot]);
    case ChannelSource::step:
      return static_cast<double>(world.head().step);
    case ChannelSource::alive:
      return static_cast<double>(world.species(slot).capacity() - state.free_count[world.shape->species_of(slot)]);
    case ChannelSource::neighbor:
      return scratch.near[int64_t{slot} * world.shape->near + i];
  }
  return 0.0;
}

}  // namespace hedon
