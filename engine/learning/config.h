/// Settings of PPO. Meaning, unit, range and source of each are in `src/hedon/config/learning.py`.
#pragma once

#include <cstdint>

#include "base/fields.h"

namespace hedon {

enum class CriticTarget : int32_t { per_state, batch_mean };
inline constexpr const char* CRITIC_TARGET_NAMES[] = {"per_state", "batch_mean"};

enum class ActingWeights : int32_t { float32, bfloat16 };
inline constexpr const char* ACTING_WEIGHTS_NAMES[] = {"float32", "bfloat16"};

struct LearningConfig {
  int32_t rollout_steps;
  int32_t minibatch_size;
  int32_t update_epochs;
  float gamma;
  float gae_lambda;
  float clip_coef;
  float learning_rate;
  float adam_beta1;
  float adam_beta2;
  float adam_epsilon;
  float value_coef;
  float entropy_coef;
  CriticTarget critic_target;
  ActingWeights acting_weights;

  HEDON_FIELDS(LearningConfig, rollout_steps, minibatch_size, update_epochs, gamma, gae_lambda, clip_coef,
               learning_rate, adam_beta1, adam_beta2, adam_epsilon, value_coef, entropy_coef, critic_target,
               acting_weights)
};

}  // namespace hedon
