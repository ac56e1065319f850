/// What agents hold: energy, and the other stores of their species. One rule for all of them.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "evolution/reward.h"
#include "world/world.h"

namespace hedon {

/// What part of its force is left to an agent that holds this much of a store that weakens its motors: 1 without any.
HEDON_FN double strength(float threshold, double held) {
  return (1.0 - logistic(held - threshold)) / (1.0 - logistic(-static_cast<double>(threshold)));
}

/// What this step's meals give the agent in `slot` of a store. Its diet's factors are on energy alone.
HEDON_FN double gained(const World& world, int32_t slot, int32_t store) {
  const Species& species = world.species(slot);
  const SpeciesLayout& layout = species.layout;
  const int32_t* meal = world.meal(slot);
  double sum = 0.0;
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    const float factor = store == ENERGY ? layout.eats_food[k] : 1.0f;
    sum += static_cast<double>(factor * layout.gives[k * species.stores() + store]) * meal[k];
  }
  return sum;
}

/// Fills and empties a store of the agent in `slot` by this step's meals and costs; energy has a ledger.
/// force    that its motors applied
/// damage   what obstacles cost it, in energy
HEDON_FN void settle_store(const World& world, int32_t slot, int32_t store, double force, double damage) {
  const StoreConfig& config = store_of(world.species(slot).config, store);
  const StepScratch& scratch = world.scratch;
  double& held = world.held(slot, store);
  world.held_before(slot)[store] = held;
  const double eaten = gained(world, slot, store);
  const double action = static_cast<double>(config.action_cost) * force;
  const double basic = config.basic_cost + static_cast<double>(config.decay) * held;
  const double wanted = held + eaten - action - basic - (store == ENERGY ? damage : 0.0);
  const double capacity = config.capacity;
  if (wanted < 0.0 && config.at_zero == StoreAtZero::death) scratch.starved[slot] = 1;
  held = wanted < 0.0 ? 0.0 : (wanted > capacity ? capacity : wanted);
  if (store != ENERGY) return;
  scratch.energy_eaten[slot] = eaten;
  scratch.energy_basic[slot] = basic;
  scratch.energy_action[slot] = action;
  scratch.energy_forgiven[slot] = wanted < 0.0 ? -wanted : 0.0;
  scratch.energy_capped[slot] = wanted > capacity ? wanted - capacity : 0.0;
}

/// Whether the agent in `slot` holds what a food of kind `k` needs.
HEDON_FN bool can_digest(const World& world, int32_t slot, int32_t k) {
  if (!world.shape->gated) return true;
  const Species& species = world.species(slot);
  for (int32_t i = 0; i < species.stores(); ++i) {
    if (world.held(slot, i) < species.layout.needs[k * species.stores() + i]) return false;
  }
  return true;
}

}  // namespace hedon
