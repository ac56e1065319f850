/// The inherited reward of one step.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "evolution/config.h"

namespace hedon {

/// What rewards may be paid for in one step of one agent.
struct RewardInputs {
  const int32_t* eaten;     ///< foods of each kind, then agents of each species
  float force;              ///< Euclidean norm of the two applied forces
  float max_force;          ///< the norm of both motors at full force; not used if the action is not normalized
  const float* ray;         ///< what it acted on: reading + 1 of each ray, 0 where it met nothing (rays)
  const uint8_t* ray_type;  ///< the channel that each ray met (rays)
  int32_t rays;
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

HEDON_FN float reward_input(const RewardConfig& config, const RewardTerm& term, const RewardInputs& inputs) {
  switch (term.input) {
    case RewardInput::food:
      return static_cast<float>(inputs.eaten[term.index]);
    case RewardInput::see_mean:
    case RewardInput::see_max:
      return sight_of(inputs, term.index, term.input == RewardInput::see_mean);
    case RewardInput::action:
      return config.action_norm == ActionNorm::max_force ? inputs.force / inputs.max_force : inputs.force;
  }
  return 0.0f;
}

/// r = Σ coef · w · x over the terms.
HEDON_FN float reward(const RewardConfig& config, const float* genome, const RewardInputs& inputs) {
  float sum = 0.0f;
  for (int32_t i = 0; i < config.terms.count; ++i) {
    const RewardTerm& term = config.terms[i];
    sum += term.coef * genome[term.gene] * reward_input(config, term, inputs);
  }
  return sum;
}

}  // namespace hedon
