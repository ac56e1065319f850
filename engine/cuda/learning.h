/// One learner's update by one block: all minibatches with parameters, gradient and moments in shared memory.
///
/// Every sum runs in the order of the CPU's kernels (`kernel/ppo_gradient.h`), so the bits match AVX2 and AVX-512,
/// whatever the number of threads. A thread computes tiles of 2 samples by 4 units.
#pragma once

#include "cuda/backward.h"
#include "cuda/forward.h"
#include "cuda/network.h"
#include "kernel/ppo_update.h"
#include "learning/gae.h"
#include "learning/rollout.h"

namespace hedon {
namespace {

/// Forward, loss and backward of at most 64 samples.
HEDON_INLINE void gradient_of_samples(const Block& block, const BlockUpdate& on, const PpoBatch& batch,
                                      const int32_t* order, int count, const LossConstants& constants,
                                      OwnTiles& square) {
  const int padded = (count + TILE - 1) / TILE * TILE;
  gather_by_block(block, on, batch, order, count);
  block.barrier();
  first_layer_by_block(block, on, batch.observation);
  block.barrier();
  second_layer_by_block(block, on);
  block.barrier();
  heads_by_block(block, on);
  block.barrier();
  loss_by_block(block, on, constants, padded);
  block.barrier();
  heads_backward_by_block(block, on, count, padded);
  block.barrier();
  second_layer_backward_by_block(block, on);
  block.barrier();
  square_gradient_by_block(block, on, count, square);
  block.barrier();
  hidden_backward_by_block(block, on);
  block.barrier();
  first_layer_backward_by_block(block, on, batch.observation, count);
  block.barrier();
}

/// Prepares a minibatch: the folded bias, the transposed square layer, empty sums.
HEDON_FN void begin_minibatch(const Block& block, const BlockUpdate& on) {
  const float* const params = on.params();
  fold_bias_by(block, on.shape, params + on.shape.b1(), on.folded_bias,
               [&](int32_t row, int unit) { return params[row * HIDDEN + unit]; });
  if constexpr (!COMPACT) {
    block.each(HIDDEN * HIDDEN,
               [&](int i) { on.w2_transposed[i] = params[on.shape.w2() + i % HIDDEN * HIDDEN + i / HIDDEN]; });
  }
  block.each(on.shape.size() + GRADIENT_SHIFT, [&](int i) { on.gradient[i] = 0.0f; });
  block.each(LOSS_SUMS * TILE, [&](int i) { on.sums[i] = 0.0f; });
  block.barrier();
}

/// The rest of a minibatch's gradient, after all of its samples.
HEDON_INLINE void finish_gradient(const Block& block, const BlockUpdate& on, OwnTiles& square) {
  const NetworkShape& shape = on.shape;
  block.each(shape.observation.ray_entries() * HIDDEN, [&](int i) {
    on.gradient[i] = on.gradient[i] - on.gradient[shape.b1() + i % HIDDEN];  // the -1 of the rays
  });
  block.each(LOSS_SUMS, [&](int i) {
    float lane[TILE];
    for (int l = 0; l < TILE; ++l) lane[l] = on.sums[i * TILE + l];
    for (int half = TILE / 2; half > 0; half /= 2) {
      for (int l = 0; l < half; ++l) lane[l] += lane[l + half];
    }
    *on.gradient_after(shape.b3() + i) = i < OUTPUTS ? lane[0] : lane[0] - on.config.entropy_coef;
  });
  if constexpr (COMPACT) {
    square.each(block, [&](const Totals& total, int from, int unit) {
      for (int i = 0; i < TILE_ROWS; ++i) write_four(on.hidden2 + (from + i) * HIDDEN + unit, total.row(i));
    });
  }
  block.barrier();
}

/// One Adam step of 16 parameters from `i` on.
HEDON_FN void adam_of_block(const BlockUpdate& on, const AdamStep& step, int32_t i) {
  const NetworkShape& shape = on.shape;
  Learner learner = on.learner;
  const float* gradient = on.gradient;
  if (COMPACT && i >= shape.b2()) {
    learner.params += PARAM_SHIFT;
    gradient += GRADIENT_SHIFT;
  } else if (COMPACT && i >= shape.w2()) {
    learner.params += (i - shape.w2()) / HIDDEN * (SQUARE_STRIDE - HIDDEN);
    gradient = on.hidden2 - shape.w2();
  }
  adam_lanes(step, i, gradient, learner);
}

/// The gradient of one minibatch, and one Adam step.
HEDON_FN void update_minibatch(const Block& block, const BlockUpdate& on, const PpoBatch& batch, const int32_t* order,
                               int64_t number) {
  begin_minibatch(block, on);
  const int32_t size = on.config.minibatch_size;
  const float* const log_sd = on.param_after(on.shape.log_sd());
  float sd_inverse[ACTIONS];
  for (int a = 0; a < ACTIONS; ++a) sd_inverse[a] = exp_lanes(Lanes{-log_sd[a]}).v;
  float target_mean = 0.0f;
  if (on.config.critic_target == LearningCriticTarget::batch_mean) {
    for (int32_t i = 0; i < size; ++i) target_mean += batch.target[order[i]];
    target_mean *= 1.0f / static_cast<float>(size);
  }
  const LossConstants constants = make_loss_constants(on.config, log_sd, sd_inverse, target_mean);
  OwnTiles square;
  for (int32_t first = 0; first < size; first += BLOCK) {
    const int count = size - first < BLOCK ? size - first : BLOCK;
    gradient_of_samples(block, on, batch, order + first, count, constants, square);
  }
  finish_gradient(block, on, square);
  const AdamStep step = make_adam_step(on.config, number);
  for (int32_t i = block.tile() * TILE; i < on.shape.size(); i += block.tiles() * TILE) adam_of_block(on, step, i);
  block.barrier();
}

/// The place of the i-th parameter of a network in shared memory.
HEDON_FN int32_t param_place(const NetworkShape& shape, int32_t i) {
  if (!COMPACT || i < shape.w2()) return i;
  return i < shape.b2() ? i + (i - shape.w2()) / HIDDEN * (SQUARE_STRIDE - HIDDEN) : i + PARAM_SHIFT;
}

/// Places an update in shared memory and copies the learner there.
HEDON_FN BlockUpdate begin_update(const Block& block, const NetworkShape& shape, const LearningConfig& config,
                                  const Learner& home) {
  const LearningLayout at = learning_layout(shape.size());
  float* const memory = shared_memory();
  const auto place = [&](int32_t where, float* elsewhere) { return where < 0 ? elsewhere : memory + where; };
  const Learner learner{memory + at.params, place(at.first_moment, home.first_moment),
                        place(at.second_moment, home.second_moment), home.updates};
  block.for_each(shape.size(), [&](int i) {
    learner.params[param_place(shape, i)] = home.params[i];
    if (at.first_moment >= 0) learner.first_moment[i] = home.first_moment[i];
    if (at.second_moment >= 0) learner.second_moment[i] = home.second_moment[i];
  });
  return {shape,
          config,
          at,
          learner,
          memory + at.gradient,
          memory + at.w2_transposed,
          memory + at.hidden1,
          memory + at.hidden2,
          memory + at.folded_bias,
          reinterpret_cast<BlockSamples*>(memory + at.samples),
          memory + at.parts,
          memory + at.sums,
          reinterpret_cast<int32_t*>(memory + at.index)};
}

/// Copies the learner back to global memory, and the weights with which the agent acts.
HEDON_FN void finish_update(const Block& block, const BlockUpdate& on, const Learner& home, int64_t updates,
                            const ActingNetwork& network) {
  block.for_each(on.shape.size(), [&](int i) {
    home.params[i] = on.learner.params[param_place(on.shape, i)];
    if (on.at.first_moment >= 0) home.first_moment[i] = on.learner.first_moment[i];
    if (on.at.second_moment >= 0) home.second_moment[i] = on.learner.second_moment[i];
    if (i == 0) *home.updates = updates;
  });
  pack_weights_by(block, on.shape, COMPACT ? home.params : on.params(), network);
  block.barrier();
}

/// Computes advantages on one thread, while others make the orders of the epochs, each from its own draws.
HEDON_FN PpoBatch prepare_update(const Block& block, const LearningConfig& config, const Rollout& rollout,
                                 const RandomStream& stream, float* scratch) {
  const int32_t count = rollout.count;
  float* const advantage = scratch;
  float* const target = advantage + count;
  int32_t* const orders = reinterpret_cast<int32_t*>(target + count);
  int32_t* const lists = orders + int64_t{config.update_epochs} * count;
  const uint32_t draws = static_cast<uint32_t>(count + 2) / 4;  // of one permutation: count - 1 numbers, 4 to a draw
  block.for_each(config.update_epochs + 1, [&](int i) {
    if (i == config.update_epochs) {
      estimate_advantage(config, rollout.reward, rollout.value, rollout.bootstrap, count, advantage, target);
      return;
    }
    int32_t* const order = orders + int64_t{i} * count;
    int32_t* const owner = lists + int64_t{i} * 2 * count;
    uint32_t index = static_cast<uint32_t>(i) * draws;
    permute(stream, count, index, order);
    sort_minibatches(count, config.minibatch_size, owner, owner + count, order);
  });
  return {rollout.observation, rollout.action, rollout.log_prob, advantage, target, orders, count};
}

/// One learner's whole update: the same as `learn`, then `NetworkKernels::pack_weights`. All threads of a block call
/// it.
HEDON_FN void learn_by_block(const Block& block, const NetworkShape& shape, const LearningConfig& config,
                             const Rollout& rollout, const RandomStream& stream, float* scratch, const Learner& home,
                             const ActingNetwork& network) {
  const PpoBatch batch = prepare_update(block, config, rollout, stream, scratch);
  const BlockUpdate on = begin_update(block, shape, config, home);
  int64_t updates = *home.updates;
  const int32_t minibatches = batch.count / config.minibatch_size;
  for (int32_t i = 0; i < config.update_epochs * minibatches; ++i) {
    const int32_t epoch = i / minibatches, first = i % minibatches * config.minibatch_size;
    update_minibatch(block, on, batch, batch.order + int64_t{epoch} * batch.count + first, ++updates);
  }
  block.barrier();
  finish_update(block, on, home, updates, network);
}

}  // namespace
}  // namespace hedon
