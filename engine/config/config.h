/// A config: its settings, and the layouts that `hedon.config.layout` derives from the names in them.
#pragma once

#include <cstdint>
#include <iterator>

#include "base/array.h"
#include "base/device.h"
#include "base/fields.h"
#include "config/schema.h"
#include "config/settable.h"

namespace hedon {

inline constexpr int MAX_TYPES = MAX_SPECIES + MAX_FOOD_KINDS + 2;  ///< each species, each food kind, wall, obstacle
inline constexpr int MAX_REWARD_TERMS = MAX_GENES + 1;              ///< each except drive reduction has a gene
inline constexpr int LEARNING_GENES = std::size(EnumNames<GenomeLearning>::text);
inline constexpr int FAMILY_GENES = std::size(EnumNames<GenomeFamily>::text);
inline constexpr int MAX_CHANNELS = 48;  ///< no rule's record and no observation has more
inline constexpr int RULE_USES = std::size(EnumNames<RuleUse>::text);

/// The first store of every species.
inline constexpr int32_t ENERGY = 0;

/// The settings of a store of a species: energy, then the others in the order of the config.
HEDON_FN const StoreConfig& store_of(const SpeciesConfig& config, int32_t store) {
  return store == ENERGY ? config.energy : config.store[store - 1];
}

/// One gene.
struct Gene {
  GeneConfig law;           ///< from which founders draw it
  MutationConfig mutation;  ///< `limit`: values are clipped to ± this
  float most;               ///< largest limit of a gene that sets this

  HEDON_FIELDS(Gene, law, mutation, most)
  static constexpr Limit LIMITS[] = {Limit(), Limit(), Limit::over(0, 1e3)};

  HEDON_FN float limit() const { return mutation.limit < most ? mutation.limit : most; }
};

/// A gene that sets a parameter of learning.
struct LearningGene {
  GenomeLearning sets;
  int32_t gene;

  HEDON_FIELDS(LearningGene, sets, gene)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(0, MAX_GENES - 1)};
};

/// A gene that sets a number of its species, which it multiplies by ten to the power of the gene.
struct SettingGene {
  GenomeSet sets;
  int32_t store;  ///< the store, for numbers of a store
  int32_t gene;

  HEDON_FIELDS(SettingGene, sets, store, gene)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(0, MAX_STORES - 1), Limit::from(0, MAX_GENES - 1)};
};

/// A quantity known about an agent in a step: see `hedon.config.channel`.
struct Channel {
  ChannelSource source;
  int32_t index;  ///< of the value within its source
  float scale;    ///< the number is divided by this

  HEDON_FIELDS(Channel, source, index, scale)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(0, 2 * MAX_TYPES - 1), Limit::over(0, 1e6)};
};

/// What a query counts or finds near an agent.
struct NeighborQuery {
  int32_t types;  ///< bit t: includes type t, a species or a kind of food
  float range;    ///< between centers [u]

  HEDON_FIELDS(NeighborQuery, types, range)
  static constexpr Limit LIMITS[] = {Limit::from(0, (1 << MAX_TYPES) - 1), Limit::over(0, 1e4)};
};

/// Whether a source is the answer to a query at the start of a step.
constexpr bool is_answer(ChannelSource source) {
  return source == ChannelSource::neighbor_count || source == ChannelSource::neighbor_kin ||
         source == ChannelSource::neighbor_distance || source == ChannelSource::neighbor_bearing;
}

/// Whether a source needs what the agent observes.
constexpr bool is_sensed(ChannelSource source) {
  return source == ChannelSource::see_mean || source == ChannelSource::see_max || source == ChannelSource::nearness ||
         source == ChannelSource::smell || source == ChannelSource::smell_mean || is_answer(source);
}

/// One term of the reward: coef · weight · channel.
struct RewardTerm {
  Channel channel;
  int32_t gene;         ///< index of the gene that weighs it; -1 for a weight of 1
  int32_t second_gene;  ///< index of the other gene, for families with two; otherwise as `gene`
  float coef;

  HEDON_FIELDS(RewardTerm, channel, gene, second_gene, coef)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(-1, MAX_GENES - 1), Limit::from(-1, MAX_GENES - 1),
                                     Limit::from(-1e3, 1e3)};
};

/// Data derived from the names in a species' settings, and from lengths and forces in other units. Types are numbered:
/// first the species, then the food kinds, walls and obstacles.
struct SpeciesLayout {
  float min_force;  ///< of each motor, for its body's size
  float max_force;
  float distance_sd;                           ///< of a child's place around its parent, along x and along y [u]
  FixedList<int32_t, MAX_TYPES> sees;          ///< types that rays meet, by channel, ascending
  FixedList<int32_t, MAX_TYPES> looks;         ///< by type, the type that it looks like, which may be itself
  FixedList<int32_t, MAX_TYPES> touches;       ///< types that it collides with and feels, by channel, ascending
  FixedList<int32_t, MAX_TYPES> smells;        ///< types that it smells, by channel, ascending
  FixedList<float, MAX_FOOD_KINDS> eats_food;  ///< factor on the energy of each kind; 0: it does not eat this kind
  FixedList<float, MAX_SPECIES> eats_species;  ///< share of the energy of each species that it gains; 0: none
  FixedList<float, MAX_FOOD_KINDS * MAX_STORES> gives;  ///< amount that each kind adds to each of its stores
  FixedList<float, MAX_FOOD_KINDS * MAX_STORES> needs;  ///< amount that it must hold in each to eat each kind
  FixedList<int32_t, RULE_USES> rules;                  ///< 1 for each use in which the caller's function decides
  FixedList<Gene, MAX_GENES> genes;                     ///< the genome, in order
  FixedList<LearningGene, LEARNING_GENES> learning;
  FixedList<SettingGene, MAX_GENES> sets;  ///< what genes set other than learning and the reward, in order
  FixedList<int32_t, FAMILY_GENES>
      family;  ///< gene that multiplies each setting by ten to the power of the gene; -1 for none
  FixedList<int32_t, MAX_STORES> set_points;  ///< gene of the set point of each store; -1 for none
  FixedList<RewardTerm, MAX_REWARD_TERMS> terms;
  FixedList<Channel, MAX_CHANNELS> observed;  ///< its observations other than rays and touch, in order
  FixedList<Channel, MAX_CHANNELS> last;      ///< values of a step that are kept for the next observation, in order
  FixedList<Channel, MAX_CHANNELS> recorded;  ///< a rule's record other than inputs, genes and memory, in order
  Channel gate;                               ///< compared, unscaled, with the threshold of the reward's family
  int32_t season_period;                      ///< steps of a year; 0: none
  FixedList<NeighborQuery, MAX_QUERIES> neighbors;

  HEDON_FIELDS(SpeciesLayout, min_force, max_force, distance_sd, sees, looks, touches, smells, eats_food, eats_species,
               gives, needs, rules, genes, learning, sets, family, set_points, terms, observed, last, recorded, gate,
               season_period, neighbors)
  static constexpr Limit TYPE = Limit::from(0, MAX_TYPES - 1), GENE = Limit::from(-1, MAX_GENES - 1),
                         YES = Limit::from(0, 1), FORCE = Limit::from(-MAX_FORCE, MAX_FORCE);
  static constexpr Limit LIMITS[] = {FORCE,
                                     FORCE,
                                     Limit::over(0, MAX_DISTANCE),
                                     TYPE,
                                     TYPE,
                                     TYPE,
                                     TYPE,
                                     Limit::from(-1e4, 1e4),
                                     YES,
                                     Limit::from(-1e4, 1e4),
                                     Limit::from(0, 1e6),
                                     YES,
                                     Limit(),
                                     Limit(),
                                     Limit(),
                                     GENE,
                                     GENE,
                                     Limit(),
                                     Limit(),
                                     Limit(),
                                     Limit(),
                                     Limit(),
                                     Limit::from(0, 1e9),
                                     Limit()};

  /// Calls visit(channel) for each channel that the species uses.
  template <class Visit>
  HEDON_FN void for_each_channel(Visit&& visit) const {
    for (int32_t i = 0; i < terms.count; ++i) visit(terms[i].channel);
    for (int32_t i = 0; i < observed.count; ++i) visit(observed[i]);
    for (int32_t i = 0; i < last.count; ++i) visit(last[i]);
    for (int32_t i = 0; i < recorded.count && has_rule(); ++i) visit(recorded[i]);
    visit(gate);
  }
  /// The gene that multiplies a setting of the family of the reward; -1 for none.
  HEDON_FN int32_t gene_of(GenomeFamily setting) const { return family[static_cast<int32_t>(setting)]; }
  /// Whether a rule of the caller decides this use.
  HEDON_FN bool has_rule(RuleUse use) const { return rules[static_cast<int32_t>(use)] != 0; }
  HEDON_FN bool has_rule() const {
    return has_rule(RuleUse::reward) || has_rule(RuleUse::hazard) || has_rule(RuleUse::birth);
  }
};

struct Config : Settings {
  FixedList<SpeciesLayout, MAX_SPECIES> layout;  ///< of each species

  HEDON_FIELDS(Config, arena, physics, obstacle, food, world, species, layout)
  static constexpr Limit LIMITS[] = {Limit(), Limit(), Limit(), Limit(), Limit(), Limit(), Limit()};
};

}  // namespace hedon
