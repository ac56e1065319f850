/// Smell: how much of each type is near an agent's noses. Sources are points with intensity e^(-decay · distance).
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "world/scene.h"
#include "world/world.h"

namespace hedon {

/// Distance beyond which all sources of a world together add less than SMELL_ERROR [u].
inline constexpr double SMELL_ERROR = 1e-4;
HEDON_FN float smell_reach(const World& world, float decay) {
  return static_cast<float>(log_double(world.shape->circles / SMELL_ERROR) / decay);
}

/// Place of nose `n`. One nose is ahead; of two, the first is on the right.
HEDON_FN Vec2 nose_at(const Species& species, int32_t n, Vec2 center, Vec2 forward) {
  const SensorConfig& sensor = species.config.sensor;
  if (sensor.noses == 1) return center + species.body.radius * forward;
  const float sine = n == 0 ? -species.nose_sine : species.nose_sine;
  return center + species.body.radius * (species.nose_cosine * forward + sine * Vec2{-forward.y, forward.x});
}

/// The intensity at one nose in each channel: min(1, Σ e^(-decay · d)) over the circles of the scene except the agent's
/// own, in the order of the scene. Needs the scene.
HEDON_FN void smell_at(const World& world, const Species& species, Vec2 nose, int32_t own, float* smelled) {
  const RayScene& scene = world.scene;
  const float decay = species.config.sensor.smell_decay;
  const float reach = smell_reach(world, decay);
  const int32_t channels = species.layout.smells.count;
  double sum[MAX_TYPES] = {};
  for_each_circle_in(world, nose, reach, [&](int32_t i) {
    const int32_t channel = species.scent.of_type[static_cast<int32_t>(scene.type[i])];
    const Vec2 apart{scene.x[i] - nose.x, scene.y[i] - nose.y};
    const float squared = squared_length(apart);
    if (channel < 0 || i == own || !(squared < reach * reach)) return;
    sum[channel] += static_cast<double>(exp_float(-decay * sqrtf(squared)));
  });
  for (int32_t c = 0; c < channels; ++c) smelled[c] = sum[c] < 1.0 ? static_cast<float>(sum[c]) : 1.0f;
}

/// Writes the smells at all noses of the agent in `slot` to its row of scratch: by channel, then by nose.
HEDON_FN void smell(const World& world, int32_t slot, Vec2 forward) {
  const Species& species = world.species(slot);
  const SensorConfig& sensor = species.config.sensor;
  const BodyState& body = world.state.physics.bodies;
  float* out = &world.scratch.smelled[int64_t{slot} * world.shape->scents];
  for (int32_t n = 0; n < sensor.noses; ++n) {
    float smelled[MAX_TYPES];
    const Vec2 nose = nose_at(species, n, {body.x[slot], body.y[slot]}, forward);
    smell_at(world, species, nose, world.scene.own[slot], smelled);
    for (int32_t c = 0; c < species.layout.smells.count; ++c) out[c * sensor.noses + n] = smelled[c];
  }
}

}  // namespace hedon
