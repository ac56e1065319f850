/// Generalized advantage estimation.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/device.h"
#include "config/schema.h"

namespace hedon {

/// Mean and standard deviation of a list.
struct Spread {
  double mean, deviation;
};
HEDON_FN Spread spread_of(const float* values, int32_t count) {
  double sum = 0.0, squares = 0.0;
  for (int32_t i = 0; i < count; ++i) sum += static_cast<double>(values[i]);
  const double mean = sum / count;
  for (int32_t i = 0; i < count; ++i) {
    const double off = static_cast<double>(values[i]) - mean;
    squares += off * off;
  }
  return {mean, sqrt(squares / count)};
}

/// The factor on rewards.
HEDON_FN float reward_factor(const LearningConfig& config, const float* reward, int32_t count) {
  if (config.reward_scaling == LearningRewardScaling::none) return 1.0f;
  const double deviation = spread_of(reward, count).deviation;
  return deviation > 0.0 ? static_cast<float>(1.0 / deviation) : 1.0f;
}

/// Gives advantages mean 0 and standard deviation 1.
HEDON_FN void normalize(float* advantage, int32_t count) {
  constexpr double SMALLEST = 1e-8;  ///< of a deviation: equal advantages become 0
  const Spread spread = spread_of(advantage, count);
  const double inverse = 1.0 / (spread.deviation + SMALLEST);
  for (int32_t i = 0; i < count; ++i)
    advantage[i] = static_cast<float>((static_cast<double>(advantage[i]) - spread.mean) * inverse);
}

/// Advantage and value target of each step of a rollout without an end of an episode.
/// reward, value       (count)
/// bootstrap           value of the observation after the last step, under the policy that acted
/// advantage, target   (count), written: the sum over l of (gamma·lambda)^l · delta_{t+l}, and that plus the value;
///                     the settings may scale rewards before, and normalize advantages after it
/// Source: Schulman et al. (2016), equation 16.
HEDON_FN void estimate_advantage(const LearningConfig& config, const float* reward, const float* value, float bootstrap,
                                 int32_t count, float* advantage, float* target) {
  const float gamma = config.gamma, lambda = config.gae_lambda;
  const float factor = reward_factor(config, reward, count);
  float next_value = bootstrap;
  float next_advantage = 0.0f;
  for (int32_t t = count - 1; t >= 0; --t) {
    const float delta = factor * reward[t] + gamma * next_value - value[t];
    next_advantage = delta + gamma * lambda * next_advantage;
    next_value = value[t];
    advantage[t] = next_advantage;
    target[t] = next_advantage + next_value;
  }
  if (config.advantage_normalization == LearningAdvantageNormalization::window) normalize(advantage, count);
}

}  // namespace hedon
