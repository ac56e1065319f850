/// Probabilities of dying and of having a child in a step, with the formulas of a config.
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

/// The part that depends on age [step].
HEDON_FN double hazard_by_age(const HazardConfig& config, double age) {
  return config.alpha_age * exp_double(config.beta_age * age);
}

/// Probability of having a child in a step, given a weighted sum of the stores, by the form of the birth rule.
HEDON_FN double birth_rate(const BirthConfig& config, double held) {
  switch (config.form) {
    case BirthForm::logistic:
      return config.kappa / (1.0 + exp_double(config.logit_offset - static_cast<double>(config.beta) * held));
    case BirthForm::threshold:
      return static_cast<double>(config.beta) * held >= config.logit_offset ? config.kappa : 0.0;
  }
  return 0.0;
}

/// The parts of the hazard that depend on all stores of the agent in `slot`, and on its age [step].
HEDON_FN double hazard_by_stores_and_age(const World& world, int32_t slot, double age) {
  const Species& species = world.species(slot);
  const HazardConfig& config = species.config.hazard;
  const auto by_store = [&](int32_t store) {
    const double weight = store_of(species.config, store).hazard_weight;
    return weight > 0.0 ? weight * hazard_by_store(config, world.held(slot, store)) : 0.0;
  };
  double chance = by_store(ENERGY) + hazard_by_age(config, age);
  for (int32_t i = 1; i < species.stores(); ++i) chance += by_store(i);
  return chance;
}

/// Probability of dying in a step at age `age` [step], given the form of the hazard.
HEDON_FN double hazard(const World& world, int32_t slot, double age) {
  const HazardConfig& config = world.species(slot).config.hazard;
  switch (config.form) {
    case HazardForm::age_energy:
      return hazard_by_stores_and_age(world, slot, age);
    case HazardForm::gompertz:
      return hazard_by_age(config, age);
    case HazardForm::constant:
      return config.kappa;
  }
  return 0.0;
}

/// Probability that the agent in `slot` dies at the end of this step.
HEDON_FN double death_chance(const World& world, int32_t slot) {
  const HazardConfig& config = world.species(slot).config.hazard;
  const double age = static_cast<double>(world.head().step + 1 - world.state.life[slot].birth_step);
  return factor_at(config.schedule.scale, world.head().step) * hazard(world, slot, age);
}

/// Probability that the agent in `slot` has a child at the end of this step.
HEDON_FN double birth_chance(const World& world, int32_t slot) {
  const Species& species = world.species(slot);
  const auto weighted = [&](int32_t store) {
    return static_cast<double>(store_of(species.config, store).birth_weight) * world.held(slot, store);
  };
  double held = weighted(ENERGY);
  for (int32_t i = 1; i < species.stores(); ++i) held += weighted(i);
  return birth_rate(species.config.birth, held);
}

}  // namespace hedon
