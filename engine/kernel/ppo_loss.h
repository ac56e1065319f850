/// The loss of PPO and its derivative with respect to the network's outputs, 16 samples at a time.
#pragma once

#include "kernel/network_table.h"
#include "kernel/ppo_scratch.h"
#include "lanes/elementary.h"

namespace hedon {
namespace {

/// Per block: the inputs of the loss for each sample, and the derivatives.
struct alignas(64) BlockSamples {
  float output[OUTPUTS][BLOCK];  ///< mean (2) and value; replaced by the derivatives of the loss
  float action[ACTIONS][BLOCK];
  float log_prob[BLOCK];
  float advantage[BLOCK];
  float target[BLOCK];
  float share[BLOCK];  ///< 1 / minibatch_size; 0 for samples that only fill the last lanes
};

/// Sums over a minibatch, lane by lane.
struct LossSums {
  Lanes policy, value;
  Lanes bias[OUTPUTS];
  Lanes log_sd[ACTIONS];
};

/// Data that all samples of a minibatch share.
struct LossConstants {
  Lanes sd_inverse[ACTIONS];
  Lanes log_scale;  ///< sum of log-sd plus log(2π), which the log-probability subtracts in addition to the squares
  Lanes clip_low, clip_high;
  Lanes value_coef;
  Lanes target_mean;
  bool batch_mean;
};

inline constexpr float LOG_TWO_PI = 1.83787707f;

/// log_sd, sd_inverse   (2) of the actions; sd_inverse is exp(-log_sd)
/// target_mean          of the minibatch; used only if the critic learns it
HEDON_INLINE LossConstants make_loss_constants(const LearningConfig& config, const float* log_sd,
                                               const float* sd_inverse, float target_mean) {
  return {{broadcast(sd_inverse[0]), broadcast(sd_inverse[1])},
          broadcast(log_sd[0] + log_sd[1] + LOG_TWO_PI),
          broadcast(1.0f - config.clip_coef),
          broadcast(1.0f + config.clip_coef),
          broadcast(config.value_coef),
          broadcast(target_mean),
          config.critic_target == LearningCriticTarget::batch_mean};
}

HEDON_INLINE LossSums zero_sums() {
  const Lanes zero = broadcast(0.0f);
  return {zero, zero, {zero, zero, zero}, {zero, zero}};
}

/// Adds 16 samples to the sums, and replaces their outputs by the derivatives of the loss.
HEDON_INLINE void loss_of_lanes(const LossConstants& constants, BlockSamples& block, int at, LossSums& sums) {
  const Lanes share = load(block.share + at);
  Lanes scaled[ACTIONS];
  unroll<ACTIONS>([&](auto d) HEDON_INLINED {
    scaled[d] = (load(block.action[d] + at) - load(block.output[d] + at)) * constants.sd_inverse[d];
  });
  const Lanes squares = multiply_add(scaled[0], scaled[0], scaled[1] * scaled[1]);
  const Lanes log_prob = broadcast(-0.5f) * squares - constants.log_scale;
  const Lanes ratio = exp_lanes(log_prob - load(block.log_prob + at));
  const Lanes advantage = load(block.advantage + at);
  const Lanes free = ratio * advantage;
  const Lanes clipped = smaller(constants.clip_high, larger(constants.clip_low, ratio)) * advantage;
  const LaneMask is_clipped = clipped < free;
  const Lanes zero = broadcast(0.0f);
  sums.policy = sums.policy - share * select(is_clipped, clipped, free);
  const Lanes grad_log_prob = zero - share * select(is_clipped, zero, free);
  unroll<ACTIONS>([&](auto d) HEDON_INLINED {
    const Lanes grad_mean = grad_log_prob * scaled[d] * constants.sd_inverse[d];
    store(block.output[d] + at, grad_mean);
    sums.bias[d] = sums.bias[d] + grad_mean;
    sums.log_sd[d] = sums.log_sd[d] + grad_log_prob * (scaled[d] * scaled[d] - broadcast(1.0f));
  });

  const Lanes target = load(block.target + at);
  const Lanes value = load(block.output[ACTIONS] + at);
  const Lanes half = broadcast(0.5f) * share;
  const Lanes error = value - (constants.batch_mean ? constants.target_mean : target);
  sums.value = sums.value + half * (error * error);
  if (constants.batch_mean) {
    // The mean of ½(V_i - T_j)² over all pairs is the mean of ½(V_i - mean T)² plus half the variance of T.
    const Lanes spread = target - constants.target_mean;
    sums.value = sums.value + half * (spread * spread);
  }
  const Lanes grad_value = constants.value_coef * share * error;
  store(block.output[ACTIONS] + at, grad_value);
  sums.bias[ACTIONS] = sums.bias[ACTIONS] + grad_value;
}

}  // namespace
}  // namespace hedon
