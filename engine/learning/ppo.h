/// One learner's work at the end of a window: advantages, the order of its minibatches, the update.
#pragma once

#include <cstdint>

#include "base/random.h"
#include "kernel/kernel.h"
#include "kernel/ppo_scratch.h"
#include "learning/gae.h"

namespace hedon {

/// The observations, actions and rewards of one agent in a window of `count` steps.
struct Rollout {
  const PackedObservation* observation;  ///< (count)
  const float* action;                   ///< (count, 2), before the sigmoid
  const float* log_prob;                 ///< (count), of the joint action
  const float* value;                    ///< (count), as estimated when acting
  const float* reward;                   ///< (count)
  float bootstrap;                       ///< value of the next observation, under the same weights
  int32_t count;                         ///< a multiple of minibatch_size
};

/// Writes a uniformly random permutation of 0 … count - 1 (Fisher and Yates), and advances `index` in the stream.
HEDON_FN void permute(const RandomStream& stream, int32_t count, uint32_t& index, int32_t* order) {
  for (int32_t i = 0; i < count; ++i) order[i] = i;
  Random4 draw{};
  int32_t used = 4;
  for (int32_t i = count - 1; i > 0; --i, ++used) {
    if (used == 4) {
      draw = stream.draw(index++);
      used = 0;
    }
    const uint32_t j = to_index(draw.word[used], static_cast<uint32_t>(i) + 1);
    const int32_t moved = order[i];
    order[i] = order[j];
    order[j] = moved;
  }
}

/// Sorts the steps of each minibatch of a permutation by time. The minibatch of a step stays random. But observations
/// change little from one step to the next, which makes the kernels faster.
/// owner, end   (count) scratch
HEDON_FN void sort_minibatches(int32_t count, int32_t minibatch_size, int32_t* owner, int32_t* end, int32_t* order) {
  for (int32_t first = 0, batch = 0; first < count; first += minibatch_size, ++batch) {
    for (int32_t i = first; i < first + minibatch_size; ++i) owner[order[i]] = batch;
    end[batch] = first;
  }
  for (int32_t step = 0; step < count; ++step) order[end[owner[step]]++] = step;
}

/// Floats of scratch that `learn` needs, aligned to 64 bytes.
HEDON_FN int64_t learn_scratch_size(const NetworkShape& shape, const LearningConfig& config) {
  return ppo_scratch_size(shape) + static_cast<int64_t>(config.rollout_steps) * (4 + config.update_epochs);
}

/// One learner's whole update from one rollout of at most `rollout_steps` steps. The order of its minibatches comes
/// from `stream`, so give each learner and window its own. Allocates nothing. Returns the means of the last epoch.
HEDON_FN PpoLoss learn(const Kernel& kernel, const NetworkShape& shape, const LearningConfig& config,
                       const Rollout& rollout, const RandomStream& stream, float* scratch, const Learner& learner) {
  float* const advantage = scratch + ppo_scratch_size(shape);
  float* const target = advantage + rollout.count;
  int32_t* const owner = reinterpret_cast<int32_t*>(target + rollout.count);
  int32_t* const end = owner + rollout.count;
  int32_t* const order = end + rollout.count;
  estimate_advantage(rollout.reward, rollout.value, rollout.bootstrap, rollout.count, config.gamma, config.gae_lambda,
                     advantage, target);
  uint32_t index = 0;
  for (int32_t epoch = 0; epoch < config.update_epochs; ++epoch) {
    int32_t* const of_epoch = order + static_cast<int64_t>(epoch) * rollout.count;
    permute(stream, rollout.count, index, of_epoch);
    sort_minibatches(rollout.count, config.minibatch_size, owner, end, of_epoch);
  }
  const PpoBatch batch = {rollout.observation, rollout.action, rollout.log_prob, advantage, target, order,
                          rollout.count};
  return kernel.update(shape, config, batch, scratch, learner);
}

}  // namespace hedon
