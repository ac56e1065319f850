/// Settings of genome, mutation and reward. Meaning, unit, range and source are in `src/hedon/config/evolution.py`.
#pragma once

#include <cstdint>

#include "base/fields.h"

namespace hedon {

enum class MutationNoise : int32_t { independent, frozen };
inline constexpr const char* MUTATION_NOISE_NAMES[] = {"independent", "frozen"};

struct GenomeConfig {
  int32_t neutral_count;
  float initial_mean_food;
  float initial_mean_action;
  float initial_sd;
  float mutation_scale;
  float weight_limit;
  MutationNoise mutation_noise;

  HEDON_FIELDS(GenomeConfig, neutral_count, initial_mean_food, initial_mean_action, initial_sd, mutation_scale,
               weight_limit, mutation_noise)
};

enum class ActionNorm : int32_t { max_force, none };
inline constexpr const char* ACTION_NORM_NAMES[] = {"max_force", "none"};

struct RewardConfig {
  float action_coef;
  ActionNorm action_norm;

  HEDON_FIELDS(RewardConfig, action_coef, action_norm)
};

}  // namespace hedon
