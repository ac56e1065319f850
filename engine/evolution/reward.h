/// The inherited reward of one step.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "config/config.h"

namespace hedon {

/// What rewards may be paid for in one step of one agent.
struct RewardInputs {
  const int32_t* eaten;     ///< foods of each kind, then agents of each species
  float force;              ///< Euclidean norm of the two applied forces
  float max_force;          ///< the norm of both motors at full force; not used if the action is not normalized
  const float* ray;         ///< what it acted on: reading + 1 of each ray, 0 where it met nothing (rays)
  const uint8_t* ray_type;  ///< the channel that each ray met (rays)
  int32_t rays;
  const float* smelled;  ///< by channel, then by nose
  int32_t noses;
  const double* before;        ///< what it held of each store before this step's meals and costs
  double now[MAX_STORES];      ///< after them
  double measure[MAX_STORES];  ///< of each store: what its set point is a share of
  double age;                  ///< steps lived, this one included
};

/// Mean or largest reading, in [0, 1], of the rays that met a type; 0 for the others.
HEDON_FN float sight_of(const RewardInputs& inputs, int32_t channel, bool mean) {
  float sum = 0.0f, largest = 0.0f;
  for (int32_t r = 0; r < inputs.rays; ++r) {
    if (inputs.ray_type[r] != channel || !(inputs.ray[r] > 0.0f)) continue;
    const float reading = inputs.ray[r] - 1.0f;
    sum += reading;
    largest = reading > largest ? reading : largest;
  }
  return mean ? sum / static_cast<float>(inputs.rays) : largest;
}

/// Drive: the distance of stores from their set points, in shares of their measures. Keramati and Gutkin (2014).
HEDON_FN double drive(const SpeciesLayout& layout, const float* genome, const double* held, const double* measure) {
  double squared = 0.0, only = 0.0;
  int32_t count = 0;
  for (int32_t s = 0; s < layout.set_points.count; ++s) {
    if (layout.set_points[s] < 0) continue;
    only = static_cast<double>(genome[layout.set_points[s]]) - held[s] / measure[s];
    squared += only * only;
    ++count;
  }
  return count == 1 ? fabs(only) : sqrt(squared);
}

/// The drive before this step's meals and costs less the drive after them.
HEDON_FN float drive_reduction(const SpeciesLayout& layout, const float* genome, const RewardInputs& inputs) {
  return static_cast<float>(drive(layout, genome, inputs.before, inputs.measure) -
                            drive(layout, genome, inputs.now, inputs.measure));
}

HEDON_FN double logistic(double x) { return 1.0 / (1.0 + exp_double(-x)); }

/// A setting, multiplied by ten to the power of a gene where there is one.
HEDON_FN double by_gene(float setting, int32_t gene, const float* genome) {
  return gene < 0 ? setting : setting * exp_double(genome[gene] * LOG_10);
}

/// By how much a value is above the threshold of a family, in units of its width.
HEDON_FN double beyond(const RewardConfig& config, const SpeciesLayout& layout, const float* genome, double value) {
  return (value - by_gene(config.threshold, layout.gene_of(GenomeFamily::threshold), genome)) /
         by_gene(config.threshold_width, layout.gene_of(GenomeFamily::threshold_width), genome);
}

/// The weight of a term, from its genes.
HEDON_FN float weight_of(const RewardConfig& config, const SpeciesLayout& layout, const RewardTerm& term,
                         const float* genome, const RewardInputs& inputs) {
  if (term.input == RewardInput::drive_reduction) return 1.0f;  // its gene is the set point
  const float w = genome[term.gene], second = genome[term.second_gene];
  switch (config.family) {
    case RewardFamily::linear:
      return w;
    case RewardFamily::sinh:
      return static_cast<float>(0.5 * (exp_double(2.5 * w) - exp_double(-2.5 * w)));
    case RewardFamily::scaled:
      return static_cast<float>(exp_double(second * LOG_10) * w);
    case RewardFamily::fed:
      return static_cast<float>(w * logistic(beyond(config, layout, genome, inputs.now[ENERGY])));
    case RewardFamily::hungry:
      return static_cast<float>(w * logistic(-beyond(config, layout, genome, inputs.now[ENERGY])));
    case RewardFamily::by_age:
      return static_cast<float>(w + (second - w) * logistic(beyond(config, layout, genome, inputs.age)));
  }
  return w;
}

HEDON_FN float reward_input(const RewardConfig& config, const SpeciesLayout& layout, const RewardTerm& term,
                            const float* genome, const RewardInputs& inputs) {
  switch (term.input) {
    case RewardInput::food:
      return static_cast<float>(inputs.eaten[term.index]);
    case RewardInput::see_mean:
    case RewardInput::see_max:
      return sight_of(inputs, term.index, term.input == RewardInput::see_mean);
    case RewardInput::smell: {
      float sum = 0.0f;
      for (int32_t n = 0; n < inputs.noses; ++n) sum += inputs.smelled[term.index * inputs.noses + n];
      return sum / static_cast<float>(inputs.noses);
    }
    case RewardInput::drive_reduction:
      return drive_reduction(layout, genome, inputs);
    case RewardInput::action:
      return config.action_norm == RewardActionNorm::max_force ? inputs.force / inputs.max_force : inputs.force;
  }
  return 0.0f;
}

/// r = Σ coef · weight · input over the terms.
HEDON_FN float reward(const RewardConfig& config, const SpeciesLayout& layout, const float* genome,
                      const RewardInputs& inputs) {
  float sum = 0.0f;
  for (int32_t i = 0; i < layout.terms.count; ++i) {
    const RewardTerm& term = layout.terms[i];
    sum += term.coef * weight_of(config, layout, term, genome, inputs) *
           reward_input(config, layout, term, genome, inputs);
  }
  return sum;
}

}  // namespace hedon
