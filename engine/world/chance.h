/// Chances of dying and of having a child in a step, by the formulas of a config.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "world/schedule.h"
#include "world/world.h"

namespace hedon {

/// The part of the hazard that depends on how full a store is.
HEDON_FN double hazard_by_store(const HazardConfig& config, double store) {
  const double x = config.alpha_energy * exp_double(-static_cast<double>(config.beta_energy) * store);
  // 1 - 1/(1 + x), in a form without cancellation for small x.
  return config.kappa * (x / (1.0 + x));
}

/// Probability of dying in a step at age `age` [step] and energy `energy`.
HEDON_FN double hazard(const HazardConfig& config, double age, double energy) {
  return hazard_by_store(config, energy) + config.alpha_age * exp_double(config.beta_age * age);
}

/// Probability of having a child in a step at energy `energy`.
HEDON_FN double birth_rate(const BirthConfig& config, double energy) {
  return config.kappa / (1.0 + exp_double(config.logit_offset - static_cast<double>(config.beta) * energy));
}

/// Probability that the agent in `slot` dies at the end of this step.
HEDON_FN double death_chance(const World& world, int32_t slot) {
  const Life& life = world.state.life[slot];
  const HazardConfig& config = world.species(slot).config->hazard;
  const double age = static_cast<double>(world.head().step + 1 - life.birth_step);
  double chance = hazard(config, age, life.energy);
  const float share = world.species(slot).config->nutrient.hazard_share;
  if (world.species(slot).layout->has_nutrient != 0)
    chance += static_cast<double>(share) * hazard_by_store(config, world.inner(slot)[0]);
  return factor_at(config.schedule.scale, world.head().step) * chance;
}

/// Probability that the agent in `slot` has a child at the end of this step.
HEDON_FN double birth_chance(const World& world, int32_t slot) {
  return birth_rate(world.species(slot).config->birth, world.state.life[slot].energy);
}

}  // namespace hedon
