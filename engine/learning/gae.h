/// Generalized advantage estimation.
#pragma once

#include <cstdint>

#include "base/device.h"

namespace hedon {

/// Advantage and value target of each step of a rollout without an end of an episode.
/// reward, value       (count)
/// bootstrap           value of the observation after the last step, under the policy that acted
/// advantage, target   (count), written: the sum over l of (gamma·lambda)^l · delta_{t+l}, and that plus the value
/// Source: Schulman et al. (2016), equation 16.
HEDON_FN void estimate_advantage(const float* reward, const float* value, float bootstrap, int32_t count, float gamma,
                                 float lambda, float* advantage, float* target) {
  float next_value = bootstrap;
  float next_advantage = 0.0f;
  for (int32_t t = count - 1; t >= 0; --t) {
    const float delta = reward[t] + gamma * next_value - value[t];
    next_advantage = delta + gamma * lambda * next_advantage;
    next_value = value[t];
    advantage[t] = next_advantage;
    target[t] = next_advantage + next_value;
  }
}

}  // namespace hedon
