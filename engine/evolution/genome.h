/// The genome: how founders draw it and how a child inherits it.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "config/config.h"

namespace hedon {

HEDON_FN float clip(float value, float low, float high) { return value < low ? low : (value > high ? high : value); }

/// A founder's genome: independent normals around the configured means.
HEDON_FN void init_genome(const SpeciesLayout& layout, const RandomStream& random, float* genome) {
  for (int32_t g = 0; g < layout.genes.count; ++g) {
    const Gene& gene = layout.genes[g];
    const Random4 bits = random.draw(static_cast<uint32_t>(g));
    const float normal = to_normal(bits.word[0], bits.word[1]).first;
    genome[g] = clip(gene.law.initial_mean + gene.law.initial_sd * normal, -gene.limit(), gene.limit());
  }
}

/// The number of a birth within its window. Frozen noise depends only on this, the seed and the gene.
struct BirthNumber {
  uint32_t births;  ///< of this window, if its genomes are drawn at its end; else of the window before
  uint32_t index;   ///< from 0, in the order of birth
};

/// The noise of a gene, of scale 1.
HEDON_FN float mutation_noise(const MutationConfig& mutation, const Random4& bits) {
  switch (mutation.law) {
    case MutationLaw::cauchy:
      return to_cauchy(bits.word[0]);
    case MutationLaw::student_t:
      return to_student_t(mutation.df, bits.word[0], bits.word[1]);
    case MutationLaw::normal:
      return to_normal(bits.word[0], bits.word[1]).first;
    case MutationLaw::uniform:
      return static_cast<float>(2.0 * to_open_uniform(bits.word[0]) - 1.0);
  }
  return 0.0f;
}

/// A child's genome: the parent's plus noise of each gene's law and scale, clipped to its limit. `parent`
/// and `child` may be the same. With frozen noise (a fault of the released code, kept for study) the noise depends on
/// the seed, the gene and the number of the birth, so all windows with equally many births use the same small table of
/// noise.
HEDON_FN void inherit(const SpeciesLayout& layout, WorldMutationNoise noise_of, uint64_t seed, uint32_t child_id,
                      BirthNumber number, const float* parent, float* child) {
  const bool frozen = noise_of == WorldMutationNoise::tabulated;
  const RandomStream random = frozen ? RandomStream{seed, Purpose::frozen_mutation, number.index, number.births}
                                     : RandomStream{seed, Purpose::mutation, child_id, 0};
  for (int32_t g = 0; g < layout.genes.count; ++g) {
    const Gene& gene = layout.genes[g];
    const Random4 bits = random.draw(static_cast<uint32_t>(g));
    const bool mutates = to_uniform(bits.word[2]) < gene.mutation.probability;
    const float noise = mutates ? gene.mutation.scale * mutation_noise(gene.mutation, bits) : 0.0f;
    child[g] = clip(parent[g] + noise, -gene.limit(), gene.limit());
  }
}

}  // namespace hedon
