/// Numbers that genes set: a gene g multiplies a number of its species by 10^g, within the limits of both.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "evolution/genome.h"
#include "world/species.h"

namespace hedon {

HEDON_FN double power_of_ten(float exponent) { return exp_double(exponent * LOG_10); }

/// Multiplies a number by a factor, within limits.
HEDON_FN void scale(float& number, double factor, float low, float high) {
  const double scaled = number * factor;
  if (scaled < static_cast<double>(low))
    number = low;
  else
    number = scaled > static_cast<double>(high) ? high : static_cast<float>(scaled);
}

/// Multiplies the number that a gene sets, or its converted value if the engine has it only in other units.
HEDON_FN void scale_setting(Species& own, const SettingGene& gene, double factor) {
  if (gene.sets == GenomeSet::motor_force_scale) {
    scale(own.layout.min_force, factor, -MAX_FORCE, MAX_FORCE);
    return scale(own.layout.max_force, factor, -MAX_FORCE, MAX_FORCE);
  }
  if (gene.sets == GenomeSet::birth_distance_sd) return scale(own.layout.distance_sd, factor, 0x1p-126f, MAX_DISTANCE);
  const SettableNumber found = settable(own.config, gene.sets, gene.store);
  scale(*found.number, factor, found.low, found.high);
}

/// The factor that a gene stands for. A genome from another source may have genes beyond the limit of this config.
HEDON_FN double factor_of(const SpeciesLayout& layout, const SettingGene& gene, const float* genome) {
  const float limit = layout.genes[gene.gene].limit();
  return power_of_ten(clip(genome[gene.gene], -limit, limit));
}

/// The radius of an agent with this genome; `smallest` and `largest` are the limits that its genes can reach.
HEDON_FN float radius_by(const Species& common, const float* genome, const BodyShape& smallest,
                         const BodyShape& largest) {
  float radius = common.config.body.radius;
  for (int32_t i = 0; i < common.layout.sets.count; ++i) {
    const SettingGene& gene = common.layout.sets[i];
    if (gene.sets == GenomeSet::body_radius)
      scale(radius, factor_of(common.layout, gene, genome), smallest.radius, largest.radius);
  }
  return radius;
}

/// Whether genes set the shapes of the bodies of a species.
HEDON_FN bool sets_body(const SpeciesLayout& layout) {
  bool found = false;
  for (int32_t i = 0; i < layout.sets.count; ++i)
    found |= layout.sets[i].sets == GenomeSet::body_radius || layout.sets[i].sets == GenomeSet::body_density;
  return found;
}

/// A species in which all genes that set numbers are at one of their limits. The struct is large; do not use it within
/// a step.
/// sign   -1 for the smallest value of each number, 1 for the largest
HEDON_FN Species extreme(const Species& common, float sign) {
  Species own = common;
  const SpeciesLayout& layout = common.layout;
  for (int32_t i = 0; i < layout.sets.count; ++i)
    scale_setting(own, layout.sets[i], power_of_ten(sign * layout.genes[layout.sets[i].gene].limit()));
  derive(own);
  return own;
}

}  // namespace hedon
