/// Genes that set learning, expressed once, at birth: a gene g multiplies the setting by 10^g.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "world/world.h"

namespace hedon {

HEDON_FN double power_of_ten(float exponent) { return exp_double(exponent * LOG_10); }

/// The settings with which the agent in `slot` learns.
HEDON_FN LearningConfig own_learning(const World& world, int32_t slot) {
  const SpeciesLayout& layout = *world.species(slot).layout;
  LearningConfig own = world.species(slot).config->learning;
  for (int32_t i = 0; i < layout.learning.count; ++i) {
    const LearningGene& set = layout.learning[i];
    const double factor = power_of_ten(world.genome(slot)[set.gene]);
    const double odds = factor * own.gamma / (1.0 - own.gamma);
    switch (set.sets) {
      case GenomeLearning::learning_rate:
        own.learning_rate = static_cast<float>(factor * own.learning_rate);
        break;
      case GenomeLearning::gamma:
        own.gamma = static_cast<float>(odds / (1.0 + odds));
        break;
      case GenomeLearning::entropy_coef:
        own.entropy_coef = static_cast<float>(factor * own.entropy_coef);
        break;
      case GenomeLearning::action_sd:
        break;  // it is in the network
    }
  }
  return own;
}

/// Sets the parts of a new network that genes set, if its species learns. The agent in `slot` has its network and its
/// genome.
HEDON_FN void express_genes(World& world, int32_t slot) {
  const Species& species = world.species(slot);
  if (!species.learns) return;
  const SpeciesLayout& layout = *species.layout;
  for (int32_t i = 0; i < layout.learning.count; ++i) {
    const LearningGene& set = layout.learning[i];
    if (set.sets != GenomeLearning::action_sd) continue;
    float* const log_sd = world.params(slot) + species.network.log_sd();
    for (int32_t a = 0; a < ACTIONS; ++a) log_sd[a] = static_cast<float>(world.genome(slot)[set.gene] * LOG_10);
  }
}

}  // namespace hedon
