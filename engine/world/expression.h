/// Genes that set numbers of a species. They are expressed once, at birth: a gene g multiplies the number by 10^g.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "world/own.h"
#include "world/world.h"

namespace hedon {

/// Gives the agent in `slot` the numbers that its genes set, in worlds with such genes. It must have its genome.
HEDON_FN void express_settings(const World& world, int32_t slot) {
  if (!world.shape->own) return;
  const Species& common = world.shape->of[world.shape->species_of(slot)];
  Species& own = world.state.own[slot] = common;
  const FixedList<SettingGene, MAX_GENES>& sets = common.layout.sets;
  for (int32_t i = 0; i < sets.count; ++i)
    scale_setting(own, sets[i], factor_of(common.layout, sets[i], world.genome(slot)));
  if (sets.count > 0) derive(own);
  if (world.shape->bodies.own != 0) world.state.physics.shape[slot] = own.body;
}

/// The settings with which the agent in `slot` learns.
HEDON_FN LearningConfig own_learning(const World& world, int32_t slot) {
  const SpeciesLayout& layout = world.species(slot).layout;
  LearningConfig own = world.species(slot).config.learning;
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

/// Applies the genes of the agent in `slot` to its numbers, and to parts of its new network if its species learns. It
/// must have its network and its genome.
HEDON_FN void express_genes(World& world, int32_t slot) {
  express_settings(world, slot);
  const Species& species = world.species(slot);
  if (!species.learns) return;
  const SpeciesLayout& layout = species.layout;
  for (int32_t i = 0; i < layout.learning.count; ++i) {
    const LearningGene& set = layout.learning[i];
    if (set.sets != GenomeLearning::action_sd) continue;
    float* const log_sd = world.params(slot) + species.network.log_sd();
    for (int32_t a = 0; a < ACTIONS; ++a) log_sd[a] = static_cast<float>(world.genome(slot)[set.gene] * LOG_10);
  }
}

}  // namespace hedon
