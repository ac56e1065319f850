/// Reads channels: quantities known about an agent in a step. `hedon.config.channel` documents each source.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "base/vec2.h"
#include "evolution/reward.h"
#include "world/neighborhood.h"
#include "world/world.h"

namespace hedon {

/// What the agent in `slot` last observed, or observes now.
HEDON_FN const PackedObservation& seen_by(const World& world, int32_t slot) {
  return world.observation(slot, world.kept(slot, world.window_step()));
}

/// Mean reading of all rays of a species, 0 for those that met nothing.
HEDON_FN float nearness(const Species& species, const PackedObservation& seen) {
  const int32_t rays = species.config.sensor.ray_count;
  float sum = 0.0f;
  for (int32_t r = 0; r < rays; ++r) sum += seen.ray[r] > 0.0f ? seen.ray[r] - 1.0f : 0.0f;
  return sum / static_cast<float>(rays);
}

/// Mean or largest reading, in [0, 1], of the rays that met a channel of sight; 0 for the others.
HEDON_FN float sight_of(const Species& species, const PackedObservation& seen, int32_t channel, bool mean) {
  const int32_t rays = species.config.sensor.ray_count;
  float sum = 0.0f, largest = 0.0f;
  for (int32_t r = 0; r < rays; ++r) {
    if (seen.ray_type[r] != channel || !(seen.ray[r] > 0.0f)) continue;
    const float reading = seen.ray[r] - 1.0f;
    sum += reading;
    largest = reading > largest ? reading : largest;
  }
  return mean ? sum / static_cast<float>(rays) : largest;
}

/// Mean intensity over the noses in a channel of smell.
HEDON_FN float smell_of(const World& world, int32_t slot, int32_t channel) {
  const int32_t noses = world.species(slot).config.sensor.noses;
  const float* smelled = &world.scratch.smelled[int64_t{slot} * world.shape->scents + channel * noses];
  float sum = 0.0f;
  for (int32_t n = 0; n < noses; ++n) sum += smelled[n];
  return sum / static_cast<float>(noses);
}

/// Number of touch sectors of the agent in `slot` that felt something in its last step, in the channels [first, last).
HEDON_FN int32_t felt_sectors(const World& world, int32_t slot, int32_t first, int32_t last) {
  const int32_t sectors = world.species(slot).config.sensor.touch_sectors;
  const auto felt = [&](int32_t bit) {
    const uint64_t bits = bit < 64 ? world.state.touch[slot] : world.state.touch_more[slot];
    return (bits >> (bit & 63)) & 1u;
  };
  int32_t count = 0;
  for (int32_t s = 0; s < sectors; ++s) {
    uint64_t any = 0;
    for (int32_t c = first; c < last; ++c) any |= felt(c * sectors + s);
    count += any != 0;
  }
  return count;
}

/// Euclidean norm of the two forces that the agent in `slot` applied in this step.
HEDON_FN float applied_force(const World& world, int32_t slot) {
  const float left = world.scratch.force_left[slot], right = world.scratch.force_right[slot];
  return sqrtf(left * left + right * right);
}

/// The drive reduction of the agent in `slot`: its drive before this step's meals and costs minus the drive after them.
HEDON_FN double drive_reduction(const World& world, int32_t slot) {
  const Species& species = world.species(slot);
  const auto measure = [&](int32_t i) {
    const StoreConfig& store = store_of(species.config, i);
    return static_cast<double>(store.motor_threshold > 0.0f ? store.motor_threshold : store.capacity);
  };
  const double* before = world.held_before(slot);
  const auto drive_at = [&](auto&& held) {
    return drive(species.config.reward, species.layout, world.genome(slot), held, measure);
  };
  return drive_at([&](int32_t i) { return before[i]; }) - drive_at([&](int32_t i) { return world.held(slot, i); });
}

/// Sine (0) or cosine (1) of the time of the year.
HEDON_FN double season(const World& world, int32_t slot, int32_t part) {
  const int64_t period = world.species(slot).layout.season_period;
  if (period == 0) return 0.0;
  double sine, cosine;
  sincos_double(2.0 * PI * static_cast<double>(world.head().step % period) / static_cast<double>(period), &sine,
                &cosine);
  return part == 0 ? sine : cosine;
}

/// The unscaled value of a channel for the agent in `slot`.
/// seen   what it observes
HEDON_FN double channel_value(const World& world, int32_t slot, const PackedObservation& seen, const Channel& channel) {
  const WorldState& state = world.state;
  const StepScratch& scratch = world.scratch;
  const BodyState& body = state.physics.bodies;
  const Species& species = world.species(slot);
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
    case ChannelSource::store_change:
      return world.held(slot, i) - world.held_before(slot)[i];
    case ChannelSource::meals:
      return static_cast<double>(world.meal(slot)[i]);
    case ChannelSource::damage:
      return scratch.energy_damage[slot];
    case ChannelSource::see_mean:
    case ChannelSource::see_max:
      return static_cast<double>(sight_of(species, seen, i, channel.source == ChannelSource::see_mean));
    case ChannelSource::nearness:
      return static_cast<double>(nearness(species, seen));
    case ChannelSource::smell:
      return static_cast<double>(scratch.smelled[int64_t{slot} * world.shape->scents + i]);
    case ChannelSource::smell_mean:
      return static_cast<double>(smell_of(world, slot, i));
    case ChannelSource::contacts:
      return felt_sectors(world, slot, i, i + 1);
    case ChannelSource::touched:
      return felt_sectors(world, slot, 0, species.layout.touches.count);
    case ChannelSource::effort:
      return static_cast<double>(applied_force(world, slot) / species.max_force);
    case ChannelSource::force:
      return static_cast<double>(i == 0 ? scratch.force_left[slot] : scratch.force_right[slot]);
    case ChannelSource::force_norm:
      return static_cast<double>(applied_force(world, slot));
    case ChannelSource::moved:
      return static_cast<double>(
          length(Vec2{body.x[slot] - scratch.start_x[slot], body.y[slot] - scratch.start_y[slot]}));
    case ChannelSource::position:
      return static_cast<double>(i == 0 ? body.x[slot] : body.y[slot]);
    case ChannelSource::age:
      return static_cast<double>(world.head().step + 1 - state.life[slot].birth_step);
    case ChannelSource::births:
      return static_cast<double>(state.births[slot]);
    case ChannelSource::waits:
      return state.ready_until[slot] >= world.head().step ? 1.0 : 0.0;
    case ChannelSource::drive_reduction:
      return drive_reduction(world, slot);
    case ChannelSource::season:
      return season(world, slot, i);
    case ChannelSource::step:
      return static_cast<double>(world.head().step);
    case ChannelSource::alive:
      return static_cast<double>(species.capacity() - state.free_count[world.shape->species_of(slot)]);
    case ChannelSource::neighbor_count:
      return answer(world, slot, i).count;
    case ChannelSource::neighbor_kin:
      return answer(world, slot, i).kin;
    case ChannelSource::neighbor_distance:
      return answer(world, slot, i).distance;
    case ChannelSource::neighbor_bearing:
      return answer(world, slot, i).bearing;
    case ChannelSource::neighbor_meals:
      return count_meals_near(world, slot, species.layout.neighbors[i]);
    case ChannelSource::one:
      return 1.0;
    case ChannelSource::last:
      return static_cast<double>(state.last[int64_t{slot} * world.shape->last + i]);
  }
  return 0.0;
}

/// The scaled value, as agents observe it and as rewards use it.
HEDON_FN float read_channel(const World& world, int32_t slot, const PackedObservation& seen, const Channel& channel) {
  return static_cast<float>(channel_value(world, slot, seen, channel)) / channel.scale;
}

/// The reward of the agent in `slot` for this step according to the config.
HEDON_FN float own_reward(const World& world, int32_t slot) {
  const Species& species = world.species(slot);
  const RewardConfig& config = species.config.reward;
  const PackedObservation& seen = seen_by(world, slot);
  const double gate = has_gate(config.family) ? channel_value(world, slot, seen, species.layout.gate) : 0.0;
  return reward(config, species.layout, world.genome(slot), gate,
                [&](const Channel& channel) { return read_channel(world, slot, seen, channel); });
}

/// Stores the values of this step that the agent in `slot` observes in the next one.
HEDON_FN void keep_last(const World& world, int32_t slot) {
  const FixedList<Channel, MAX_CHANNELS>& last = world.species(slot).layout.last;
  for (int32_t i = 0; i < last.count; ++i) {
    const double value = channel_value(world, slot, seen_by(world, slot), last[i]);
    world.state.last[int64_t{slot} * world.shape->last + i] = static_cast<float>(value);
  }
}

}  // namespace hedon
