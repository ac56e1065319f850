/// One species of a world: its settings and the data derived from them, computed once and never changed.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/math.h"
#include "base/vec2.h"
#include "config/config.h"
#include "learning/network.h"
#include "physics/body.h"

namespace hedon {

/// The channel of each type in a sense; -1 for types that it does not meet.
struct Channels {
  int8_t of_type[MAX_TYPES];
  bool in_order;  ///< every type has the channel of its own number: the channel is the type
};

HEDON_FN Channels make_channels(const FixedList<int32_t, MAX_TYPES>& list, int32_t types) {
  Channels channels{};
  channels.in_order = list.count == types;
  for (int32_t type = 0; type < MAX_TYPES; ++type) channels.of_type[type] = -1;
  for (int32_t c = 0; c < list.count; ++c) channels.of_type[list[c]] = static_cast<int8_t>(c);
  return channels;
}

/// The channels of sight, in which a type that looks like another one shares its channel.
HEDON_FN Channels make_sight(const SpeciesLayout& layout, int32_t types) {
  Channels sight = make_channels(layout.sees, types);
  for (int32_t type = 0; type < types; ++type) sight.of_type[type] = sight.of_type[layout.looks[type]];
  return sight;
}

/// One piece of memory without pointers, since agents whose genes set parts of it have their own copies.
struct Species {
  SpeciesConfig config;
  SpeciesLayout layout;
  int32_t first_slot;  ///< it owns slots [first_slot, last_slot)
  int32_t last_slot;
  NetworkShape network;
  BodyShape body;
  Channels sight, touch, scent;
  bool has_network;                      ///< its agents act by networks
  bool learns;                           ///< these networks learn
  bool observes;                         ///< its network, or its reward, uses its rays
  int32_t record;                        ///< numbers that a rule of the caller gets for one agent
  float motor_arm;                       ///< lever of each motor about the center [u]
  float max_force;                       ///< largest norm of the two forces: the norm of (f_max, f_max)
  float nose_sine, nose_cosine;          ///< of the angle of a nose to the heading
  float mouth_cosine;                    ///< cosine of the mouth's half angle
  Vec2 mouth_center;                     ///< direction of its middle: ahead, and to the left
  alignas(64) float ray_sine[MAX_RAYS];  ///< of each ray's angle to the heading; past the last ray the last repeats
  alignas(64) float ray_cosine[MAX_RAYS];
  bool fan_convex;        ///< the fan spans less than half a turn
  bool arc_convex;        ///< 16 neighboring rays do
  float sector_sine[65];  ///< of each touch sector's first edge, counter-clockwise of the heading
  float sector_cosine[65];

  HEDON_FN int32_t capacity() const { return last_slot - first_slot; }
  HEDON_FN int32_t stores() const { return 1 + config.store.count; }
};

/// The directions of the rays and of the edges of touch sectors.
HEDON_FN void set_directions(Species& species) {
  const SensorConfig& sensor = species.config.sensor;
  const double degree = PI / 180.0;
  double sine, cosine;
  const int32_t rays = sensor.ray_count;
  const double spread = sensor.ray_spread * degree;
  for (int32_t r = 0; r < MAX_RAYS; ++r) {
    const int32_t ray = r < rays ? r : rays - 1;
    const double angle = rays == 1 ? 0.0 : -spread + 2.0 * spread * ray / (rays - 1);
    sincos_double(angle, &sine, &cosine);
    species.ray_sine[r] = static_cast<float>(sine);
    species.ray_cosine[r] = static_cast<float>(cosine);
  }
  species.fan_convex = sensor.ray_spread < 90.0f;
  species.arc_convex =
      species.fan_convex || (rays > 16 && sensor.ray_spread * 15.0f < 90.0f * static_cast<float>(rays - 1));
  for (int32_t s = 0; s <= sensor.touch_sectors; ++s) {
    sincos_double(2.0 * PI * s / sensor.touch_sectors, &sine, &cosine);
    species.sector_sine[s] = static_cast<float>(sine);
    species.sector_cosine[s] = static_cast<float>(cosine);
  }
}

/// Computes the data derived from the numbers of a species.
HEDON_FN void derive(Species& species) {
  const SpeciesConfig& config = species.config;
  species.body = make_disc(config.body.radius, config.body.density);
  double sine, cosine;
  sincos_double(config.motor.angle * (PI / 180.0), &sine, &cosine);
  species.motor_arm = static_cast<float>(config.body.radius * sine);
  species.max_force = species.layout.max_force * sqrtf(2.0f);
  sincos_double(config.sensor.nose_angle * (PI / 180.0), &sine, &cosine);
  species.nose_sine = static_cast<float>(sine);
  species.nose_cosine = static_cast<float>(cosine);
  sincos_double(config.sensor.mouth_spread * (PI / 180.0), &sine, &cosine);
  // A mouth on all sides: rounding must not leave a gap directly behind.
  species.mouth_cosine = config.sensor.mouth_spread < 180.0f ? static_cast<float>(cosine) : -2.0f;
  sincos_double(config.sensor.mouth_center * (PI / 180.0), &sine, &cosine);
  species.mouth_center = {static_cast<float>(cosine), static_cast<float>(sine)};
  set_directions(species);
}

/// types   of a world that senses may tell apart
HEDON_FN Species make_species(const SpeciesConfig& config, const SpeciesLayout& layout, int32_t first_slot,
                              int32_t types) {
  Species species{};
  species.config = config;
  species.layout = layout;
  species.first_slot = first_slot;
  species.last_slot = first_slot + config.population.capacity;
  species.sight = make_sight(layout, types);
  species.touch = make_channels(layout.touches, types);
  species.scent = make_channels(layout.smells, types);
  species.learns = config.learning.policy == LearningPolicy::ppo;
  species.has_network = species.learns || config.learning.policy == LearningPolicy::fixed;
  species.observes = species.has_network;
  species.observes |= layout.has_rule();
  species.record = layout.terms.count + layout.genes.count + layout.recorded.count + 1 + config.reward.memory;
  for (int32_t i = 0; i < layout.terms.count; ++i) species.observes |= is_sensed(layout.terms[i].channel.source);
  species.observes |= is_sensed(layout.gate.source);
  species.network = {{config.sensor.ray_count, layout.sees.count, layout.touches.count * config.sensor.touch_sectors,
                      layout.observed.count, NARROW_LINES}};
  derive(species);
  return species;
}

/// Heading 0 points along +y; positive is counter-clockwise.
HEDON_FN Vec2 heading(float angle) {
  float sine, cosine;
  sincos_float(angle, &sine, &cosine);
  return {-sine, cosine};
}

/// Direction of ray `r` of an agent with heading `forward`; past the last ray, the last one repeats.
HEDON_FN Vec2 ray_direction(const Species& species, int32_t r, Vec2 forward) {
  return species.ray_cosine[r] * forward + species.ray_sine[r] * Vec2{-forward.y, forward.x};
}

}  // namespace hedon
