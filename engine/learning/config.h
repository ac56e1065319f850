/// Settings of PPO. Meaning, unit, range and source of each are in `src/hedon/config/learning.py`.
#pragma once

#include <cstdint>

#include "base/fields.h"

namespace hedon {

enum class CriticTarget : int32_t { per_state, batch_mean };
inline constexpr const char* CRITIC_TARGET_NAMES[] = {"per_state", "batch_mean"};

enum class ActingWeights : int32_t { float32, bfloat16 };
inline constexpr const char* ACTING_WEIGHTS_NAMES[] = {"float32", "bfloat16"};

/// How agents choose what to do.
enum class Policy : int32_t {
  ppo,       ///< by a network of their own, which learns
  random,    ///< by a standard normal, as a network does that has not learned
  idle,      ///< the motors never run
  external,  ///< the caller gives it, step by step
  fixed,     ///< by a network that never learns
};
inline constexpr const char* POLICY_NAMES[] = {"ppo", "random", "idle", "external", "fixed"};

struct LearningConfig {
  Policy policy;
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

  HEDON_FIELDS(LearningConfig, policy, rollout_steps, minibatch_size, update_epochs, gamma, gae_lambda, clip_coef,
               learning_rate, adam_beta1, adam_beta2, adam_epsilon, value_coef, entropy_coef, critic_target,
               acting_weights)
};

}  // namespace hedon
