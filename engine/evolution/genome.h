/// The genome: one reward weight per food kind, one for action, then neutral markers without effect on rewards.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "evolution/config.h"

namespace hedon {

/// The index of each gene. Neutral markers mutate like the others: they are the control for drift.
struct GenomeShape {
  int32_t kinds;
  int32_t neutral;

  HEDON_FN int32_t action() const { return kinds; }
  HEDON_FN int32_t size() const { return kinds + 1 + neutral; }
};

HEDON_FN float clip(float value, float low, float high) { return value < low ? low : (value > high ? high : value); }

/// The law from which founders draw gene `g`.
HEDON_FN const GeneConfig& initial_gene(const GenomeShape& shape, const GenomeConfig& config, int32_t g) {
  return g < shape.kinds ? config.food[g] : g == shape.action() ? config.action : config.neutral;
}

/// A founder's genome: independent normals around the configured means.
HEDON_FN void init_genome(const GenomeShape& shape, const GenomeConfig& config, const RandomStream& random,
                          float* genome) {
  for (int32_t g = 0; g < shape.size(); ++g) {
    const GeneConfig& gene = initial_gene(shape, config, g);
    const Random4 bits = random.draw(static_cast<uint32_t>(g));
    genome[g] = clip(gene.initial_mean + gene.initial_sd * to_normal(bits.word[0], bits.word[1]).first,
                     -config.weight_limit, config.weight_limit);
  }
}

/// Which birth of its window a birth is: all that frozen noise depends on, beside the seed and the gene.
struct BirthNumber {
  uint32_t births;  ///< of this window, if its genomes are drawn at its end; else of the window before
  uint32_t index;   ///< from 0, in the order of birth
};

/// A child's genome: the parent's plus Cauchy noise of scale `mutation_scale`, clipped to the weight limit. `parent`
/// and `child` may be the same. With frozen noise (a fault of the released code, kept for study) the noise depends on
/// the seed, the gene and the number of the birth, so all windows with equally many births use the same small table of
/// noise.
HEDON_FN void inherit(const GenomeShape& shape, const GenomeConfig& config, uint64_t seed, uint32_t child_id,
                      BirthNumber number, const float* parent, float* child) {
  const bool frozen = config.mutation_noise == MutationNoise::frozen;
  const RandomStream random = frozen ? RandomStream{seed, Purpose::frozen_mutation, number.index, number.births}
                                     : RandomStream{seed, Purpose::mutation, child_id, 0};
  for (int32_t g = 0; g < shape.size(); ++g) {
    const float noise = to_cauchy(random.draw(static_cast<uint32_t>(g)).word[0]);
    child[g] = clip(parent[g] + config.mutation_scale * noise, -config.weight_limit, config.weight_limit);
  }
}

}  // namespace hedon
