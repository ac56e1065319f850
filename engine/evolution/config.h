/// Settings of genome, mutation and reward. Meaning, unit, range and source are in `src/hedon/config/evolution.py`.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"

namespace hedon {

enum class MutationNoise : int32_t { independent, frozen };
inline constexpr const char* MUTATION_NOISE_NAMES[] = {"independent", "frozen"};

inline constexpr int MAX_FOOD_KINDS = 8;

/// The law from which founders draw one gene.
struct GeneConfig {
  float initial_mean;
  float initial_sd;

  HEDON_FIELDS(GeneConfig, initial_mean, initial_sd)
};

struct GenomeConfig {
  int32_t neutral_count;
  float mutation_scale;
  float weight_limit;
  MutationNoise mutation_noise;
  GeneConfig action;
  GeneConfig neutral;                          ///< of every neutral marker
  FixedList<GeneConfig, MAX_FOOD_KINDS> food;  ///< of each kind's weight

  HEDON_FIELDS(GenomeConfig, neutral_count, mutation_scale, weight_limit, mutation_noise, action, neutral, food)
};

enum class ActionNorm : int32_t { max_force, none };
inline constexpr const char* ACTION_NORM_NAMES[] = {"max_force", "none"};

struct RewardConfig {
  float action_coef;
  ActionNorm action_norm;

  HEDON_FIELDS(RewardConfig, action_coef, action_norm)
};

}  // namespace hedon
