/// Settings of genome, mutation and reward: what `hedon.config.layout` makes of the sections [genome] and [reward].
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"

namespace hedon {

enum class MutationNoise : int32_t { independent, frozen };
inline constexpr const char* MUTATION_NOISE_NAMES[] = {"independent", "frozen"};

inline constexpr int MAX_GENES = 64;
inline constexpr int MAX_REWARD_TERMS = 32;  ///< more than foods, species, action and sights together

enum class MutationLaw : int32_t { cauchy, student_t, normal, uniform };
inline constexpr const char* MUTATION_LAW_NAMES[] = {"cauchy", "student_t", "normal", "uniform"};

/// One gene: the law from which founders draw it, and how it mutates.
struct GeneConfig {
  float initial_mean;
  float initial_sd;
  MutationLaw mutation_law;
  float mutation_scale;
  float mutation_df;           ///< degrees of freedom of student_t
  float mutation_probability;  ///< that the gene mutates at a birth
  float limit;                 ///< values are clipped to ± this

  HEDON_FIELDS(GeneConfig, initial_mean, initial_sd, mutation_law, mutation_scale, mutation_df, mutation_probability,
               limit)
};

/// The layout of a genome: its genes in order. What a gene does is said where it is read: `RewardTerm::gene`.
struct GenomeConfig {
  MutationNoise mutation_noise;
  FixedList<GeneConfig, MAX_GENES> genes;

  HEDON_FIELDS(GenomeConfig, mutation_noise, genes)
};

enum class ActionNorm : int32_t { max_force, none };
inline constexpr const char* ACTION_NORM_NAMES[] = {"max_force", "none"};

/// What a reward is paid for, per step.
enum class RewardInput : int32_t {
  food,      ///< foods of kind `index` eaten; past the kinds, agents of a species
  action,    ///< norm of the two forces, divided as `ActionNorm` says
  see_mean,  ///< mean over the rays of the reading of sight channel `index`
  see_max,   ///< the largest of them
};
inline constexpr const char* REWARD_INPUT_NAMES[] = {"food", "action", "see_mean", "see_max"};

/// One term of the reward: coef · (gene's value) · input.
struct RewardTerm {
  RewardInput input;
  int32_t index;  ///< of the food kind or sight channel
  int32_t gene;   ///< index of the gene that weighs it
  float coef;

  HEDON_FIELDS(RewardTerm, input, index, gene, coef)
};

/// The layout of a reward: its terms in order.
struct RewardConfig {
  ActionNorm action_norm;
  FixedList<RewardTerm, MAX_REWARD_TERMS> terms;

  HEDON_FIELDS(RewardConfig, action_norm, terms)
};

}  // namespace hedon
