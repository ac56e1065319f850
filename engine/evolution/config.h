/// Settings of genome, mutation and reward: what `hedon.config.layout` makes of the sections [genome] and [reward].
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"

namespace hedon {

enum class MutationNoise : int32_t { independent, tabulated };
inline constexpr const char* MUTATION_NOISE_NAMES[] = {"independent", "tabulated"};

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

/// What of learning a gene may set.
enum class LearningParameter : int32_t {
  learning_rate,  ///< 10^g times the configured one
  gamma,          ///< 10^g times its odds, gamma / (1 - gamma)
  entropy_coef,   ///< 10^g times the configured one
  action_sd,      ///< 10^g times the standard deviation with which a new network acts
};
inline constexpr const char* LEARNING_PARAMETER_NAMES[] = {"learning_rate", "gamma", "entropy_coef", "action_sd"};
inline constexpr int LEARNING_PARAMETERS = 4;

/// A gene that sets a parameter of learning.
struct LearningGene {
  LearningParameter sets;
  int32_t gene;

  HEDON_FIELDS(LearningGene, sets, gene)
};

/// The layout of a genome: its genes in order. What a gene does is described where it is read: here for those that set
/// learning, and in `RewardTerm::gene`.
struct GenomeConfig {
  MutationNoise mutation_noise;
  FixedList<GeneConfig, MAX_GENES> genes;
  FixedList<LearningGene, LEARNING_PARAMETERS> learning;

  HEDON_FIELDS(GenomeConfig, mutation_noise, genes, learning)
};

enum class ActionNorm : int32_t { max_force, none };
inline constexpr const char* ACTION_NORM_NAMES[] = {"max_force", "none"};

/// What a reward is paid for, per step.
enum class RewardInput : int32_t {
  food,             ///< foods of kind `index` eaten; past the kinds, agents of a species
  action,           ///< norm of the two forces, divided by what `ActionNorm` names
  see_mean,         ///< mean over the rays of the reading of sight channel `index`
  see_max,          ///< the largest of them
  smell,            ///< mean over the noses of what they smell of channel `index`
  drive_reduction,  ///< by how much inner states came closer to their set points, in shares of their capacities
};
inline constexpr const char* REWARD_INPUT_NAMES[] = {"food",    "action", "see_mean",
                                                     "see_max", "smell",  "drive_reduction"};

constexpr bool is_sight(RewardInput input) { return input == RewardInput::see_mean || input == RewardInput::see_max; }
/// Whether an input needs what the agent observes.
constexpr bool is_sensed(RewardInput input) { return is_sight(input) || input == RewardInput::smell; }

/// How a weight follows from its genes. x is the distance of energy or age from `threshold`, in units of
/// `threshold_width`.
enum class RewardFamily : int32_t {
  linear,  ///< w
  sinh,    ///< sinh(2.5 w)
  scaled,  ///< 10^s w, s the second gene
  fed,     ///< w σ(x) of energy
  hungry,  ///< w σ(-x) of energy
  by_age,  ///< w + (w' - w) σ(x) of age, w' the second gene
};
inline constexpr const char* REWARD_FAMILY_NAMES[] = {"linear", "sinh", "scaled", "fed", "hungry", "by_age"};

/// What an agent holds, in the order in which drives count them.
enum InnerState : int32_t { ENERGY, NUTRIENT, TOXIN, INNER_STATES };

/// One term of the reward: coef · weight · input.
struct RewardTerm {
  RewardInput input;
  int32_t index;        ///< of the food kind, or of the channel of sight or smell
  int32_t gene;         ///< index of the gene that weighs it
  int32_t second_gene;  ///< of the other gene, for the families that have two; otherwise as `gene`
  float coef;

  HEDON_FIELDS(RewardTerm, input, index, gene, second_gene, coef)
};

/// The layout of a reward: its terms in order.
struct RewardConfig {
  ActionNorm action_norm;
  RewardFamily family;
  float threshold;               ///< of energy [energy] or age [step], for the families that depend on them
  float threshold_width;         ///< in the same unit
  int32_t rule;                  ///< 1 if a function of the caller pays, and not the terms
  int32_t threshold_gene;        ///< multiplies `threshold` by ten to its power; -1 for none
  int32_t threshold_width_gene;  ///< the same for `threshold_width`
  int32_t memory;                ///< numbers that the rule keeps for each agent
  FixedList<int32_t, INNER_STATES> set_points;  ///< gene of the set point of each inner state; -1 for none
  FixedList<RewardTerm, MAX_REWARD_TERMS> terms;

  HEDON_FIELDS(RewardConfig, action_norm, family, threshold, threshold_width, rule, threshold_gene,
               threshold_width_gene, memory, set_points, terms)
};

}  // namespace hedon
