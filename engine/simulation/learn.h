/// One learner's work at the end of a window: advantages, the order of its minibatches, the update.
#pragma once

#include <cstdint>

#include "base/random.h"
#include "kernel/kernel.h"
#include "kernel/ppo_scratch.h"
#include "learning/gae.h"
#include "learning/rollout.h"

namespace hedon {

/// Floats of scratch that `learn` needs, aligned to 64 bytes.
HEDON_FN int64_t learn_scratch_size(const NetworkShape& shape, const LearningConfig& config, int64_t rollout_steps) {
  return ppo_scratch_size(shape) + rollout_steps * (4 + config.update_epochs);
}

/// One learner's whole update from one rollout of at most `rollout_steps` steps. The order of its minibatches comes
/// from `stream`, so give each learner and window its own. Allocates nothing. Returns the means of the last epoch.
HEDON_FN PpoLoss learn(const NetworkKernels& kernels, const NetworkShape& shape, const LearningConfig& config,
                       const Rollout& rollout, const RandomStream& stream, float* scratch, const Learner& learner) {
  float* const advantage = scratch + ppo_scratch_size(shape);
  float* const target = advantage + rollout.count;
  int32_t* const owner = reinterpret_cast<int32_t*>(target + rollout.count);
  int32_t* const end = owner + rollout.count;
  int32_t* const order = end + rollout.count;
  estimate_advantage(config, rollout.reward, rollout.value, rollout.bootstrap, rollout.count, advantage, target);
  uint32_t index = 0;
  for (int32_t epoch = 0; epoch < config.update_epochs; ++epoch) {
    int32_t* const of_epoch = order + static_cast<int64_t>(epoch) * rollout.count;
    permute(stream, rollout.count, index, of_epoch);
    sort_minibatches(rollout.count, config.minibatch_size, owner, end, of_epoch);
  }
  const PpoBatch batch = {rollout.observation, rollout.action, rollout.log_prob, advantage, target, order,
                          rollout.count};
  return kernels.update(shape, config, batch, scratch, learner);
}

}  // namespace hedon
