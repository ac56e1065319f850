/// The inherited reward of one step: terms over channels. Independent of worlds.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "config/config.h"

namespace hedon {

/// base^exponent, for a base of at least 0 and an exponent above 0.
HEDON_FN double power(double base, double exponent) {
  return base > 0.0 ? exp_double(exponent * log_double(base)) : 0.0;
}

/// Drive: (Σ |set point − held|^n)^(1/m) over the stores, each relative to its measure. held(s) and measure(s) give the
/// amount and the measure of store `s`. Source: Keramati and Gutkin (2014).
template <class Held, class Measure>
HEDON_FN double drive(const RewardConfig& config, const SpeciesLayout& layout, const float* genome, Held&& held,
                      Measure&& measure) {
  const bool is_euclidean = config.drive_exponent == 2.0f && config.drive_root == 2.0f;
  double sum = 0.0, only = 0.0;
  int32_t count = 0;
  for (int32_t s = 0; s < layout.set_points.count; ++s) {
    if (layout.set_points[s] < 0) continue;
    only = static_cast<double>(genome[layout.set_points[s]]) - held(s) / measure(s);
    sum += is_euclidean ? only * only : power(fabs(only), config.drive_exponent);
    ++count;
  }
  if (!is_euclidean) return power(sum, 1.0 / config.drive_root);
  return count == 1 ? fabs(only) : sqrt(sum);
}

HEDON_FN double logistic(double x) { return 1.0 / (1.0 + exp_double(-x)); }

/// A setting, multiplied by ten to the power of its gene, if it has one.
HEDON_FN double by_gene(float setting, int32_t gene, const float* genome) {
  return gene < 0 ? setting : setting * exp_double(genome[gene] * LOG_10);
}

/// Whether the weights of a family depend on a gate, as in the families from `above` on.
constexpr bool has_gate(RewardFamily family) { return family >= RewardFamily::above; }

/// The distance of a gate above the threshold of a family, in units of its width.
HEDON_FN double beyond(const RewardConfig& config, const SpeciesLayout& layout, const float* genome, double gate) {
  return (gate - by_gene(config.threshold, layout.gene_of(GenomeFamily::threshold), genome)) /
         by_gene(config.threshold_width, layout.gene_of(GenomeFamily::threshold_width), genome);
}

/// The weight of a term, from its genes and the gate.
HEDON_FN float weight_of(const RewardConfig& config, const SpeciesLayout& layout, const RewardTerm& term,
                         const float* genome, double gate) {
  if (term.gene < 0) return 1.0f;
  const float w = genome[term.gene], second = genome[term.second_gene];
  switch (config.family) {
    case RewardFamily::linear:
      return w;
    case RewardFamily::sinh:
      return static_cast<float>(0.5 * (exp_double(2.5 * w) - exp_double(-2.5 * w)));
    case RewardFamily::scaled:
      return static_cast<float>(exp_double(second * LOG_10) * w);
    case RewardFamily::above:
      return static_cast<float>(w * logistic(beyond(config, layout, genome, gate)));
    case RewardFamily::below:
      return static_cast<float>(w * logistic(-beyond(config, layout, genome, gate)));
    case RewardFamily::between:
      return static_cast<float>(w + (second - w) * logistic(beyond(config, layout, genome, gate)));
    case RewardFamily::around: {
      const double x = beyond(config, layout, genome, gate);
      return static_cast<float>(4.0 * w * logistic(x) * logistic(-x));
    }
  }
  return w;
}

/// r = Σ coef · weight · channel over the terms. `read(channel)` gives a channel's value.
template <class Read>
HEDON_FN float reward(const RewardConfig& config, const SpeciesLayout& layout, const float* genome, double gate,
                      Read&& read) {
  float sum = 0.0f;
  for (int32_t i = 0; i < layout.terms.count; ++i) {
    const RewardTerm& term = layout.terms[i];
    sum += term.coef * weight_of(config, layout, term, genome, gate) * read(term.channel);
  }
  return sum;
}

}  // namespace hedon
