/// The stores of agents: energy, and the others of their species, all under one rule.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "evolution/reward.h"
#include "world/world.h"

namespace hedon {

/// The share of its force left to an agent with this amount in a store that weakens its motors; 1 if the store is
/// empty.
HEDON_FN double strength(float threshold, double held) {
  return (1.0 - logistic(held - threshold)) / (1.0 - logistic(-static_cast<double>(threshold)));
}

/// The amount that this step's meals add to a store of the agent in `slot`. The factors of its diet apply to energy
/// only.
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

/// Applies this step's meals and costs to a store of the agent in `slot`; energy is also recorded in the ledger.
/// force    that its motors applied
/// damage   energy lost to obstacles
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

/// Whether the agent in `slot` holds what it needs to eat a food of kind `k`.
HEDON_FN bool can_digest(const World& world, int32_t slot, int32_t k) {
  if (!world.shape->gated) return true;
  const Species& species = world.species(slot);
  for (int32_t i = 0; i < species.stores(); ++i) {
    if (world.held(slot, i) < species.layout.needs[k * species.stores() + i]) return false;
  }
  return true;
}

}  // namespace hedon
