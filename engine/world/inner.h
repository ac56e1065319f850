/// Inner states beside energy: a second nutrient, and a toxin that weakens the motors.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "evolution/reward.h"
#include "world/world.h"

namespace hedon {

/// What part of its force is left to an agent that holds this much toxin: 1 without any.
HEDON_FN double strength(const ToxinConfig& config, double toxin) {
  return (1.0 - logistic(toxin - config.threshold)) / (1.0 - logistic(-static_cast<double>(config.threshold)));
}

/// Sets the inner states of a newcomer.
HEDON_FN void set_inner(const World& world, int32_t slot, double nutrient, double toxin) {
  world.inner(slot)[0] = nutrient;
  world.inner(slot)[1] = toxin;
}

/// Fills and empties the stores of one agent by this step's meals and costs. `force` is what its motors applied.
HEDON_FN void update_inner(const World& world, int32_t slot, double force) {
  const SpeciesConfig& config = *world.species(slot).config;
  const SpeciesLayout& layout = *world.species(slot).layout;
  double* const now = world.inner(slot);
  double eaten = 0.0, poisoned = 0.0;
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    eaten += static_cast<double>(world.config->food[k].nutrient) * world.meal(slot)[k];
    poisoned += static_cast<double>(world.config->food[k].toxin) * world.meal(slot)[k];
  }
  for (int32_t s = 0; s < 2; ++s) world.inner_before(slot)[s] = now[s];
  if (layout.has_nutrient != 0) {
    const double wanted =
        now[0] + eaten - static_cast<double>(config.nutrient.action_cost) * force - config.nutrient.basic_cost;
    now[0] = wanted < 0.0 ? 0.0 : (wanted > config.nutrient.capacity ? config.nutrient.capacity : wanted);
  }
  if (layout.has_toxin != 0) {
    const double left = now[1] + poisoned - config.toxin.decay;
    now[1] = left < 0.0 ? 0.0 : left;
  }
}

}  // namespace hedon
