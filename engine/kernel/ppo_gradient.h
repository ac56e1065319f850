/// Loss and gradient of one minibatch of PPO, in blocks of samples that stay in the caches.
#pragma once

#include "kernel/network_forward.h"
#include "kernel/ppo_loss.h"
#include "kernel/ppo_scratch.h"
#include "lanes/transpose.h"

namespace hedon {
namespace {

/// The samples `order[0 .. count)` of a block: pointers to their observations, and the data for the loss, filled up to
/// a multiple of 16 by repeating the last one with share 0.
HEDON_INLINE void gather(const ObservationShape& shape, const PpoBatch& batch, const int32_t* order, int count,
                         float share, BlockSamples& block, const PackedObservation** observation) {
  const int padded = (count + LANES - 1) / LANES * LANES;
  for (int s = 0; s < padded; ++s) {
    const int32_t i = order[s < count ? s : count - 1];
    observation[s] = observation_at(shape, batch.observation, i);
    block.action[0][s] = batch.action[ACTIONS * i];
    block.action[1][s] = batch.action[ACTIONS * i + 1];
    block.log_prob[s] = batch.log_prob[i];
    block.advantage[s] = batch.advantage[i];
    block.target[s] = batch.target[i];
    block.share[s] = s < count ? share : 0.0f;
  }
}

/// Backward through the heads: adds to the gradients of their weights and of the second bias, and replaces the second
/// hidden layer by the derivative with respect to that layer's sums.
HEDON_INLINE void heads_backward(const NetworkShape& shape, const float* params, const BlockSamples& block, int count,
                                 float* hidden2, float* gradient) {
  for (int column = 0; column < HIDDEN; column += LANES) {
    Lanes weight[OUTPUTS];
    Lanes total[OUTPUTS];
    unroll<OUTPUTS>([&](auto o) HEDON_INLINED {
      weight[o] = load(params + shape.w3() + o * HIDDEN + column);
      total[o] = load(gradient + shape.w3() + o * HIDDEN + column);
    });
    Lanes bias = load(gradient + shape.b2() + column);
    float* hidden = hidden2 + column;
    for (int s = 0; s < count; ++s, hidden += HIDDEN) {
      const Lanes h = load(hidden);
      Lanes grad_hidden = broadcast(block.output[0][s]) * weight[0];
      total[0] = multiply_add(broadcast(block.output[0][s]), h, total[0]);
      unroll<OUTPUTS - 1>([&](auto o) HEDON_INLINED {
        const Lanes grad_output = broadcast(block.output[o + 1][s]);
        grad_hidden = multiply_add(grad_output, weight[o + 1], grad_hidden);
        total[o + 1] = multiply_add(grad_output, h, total[o + 1]);
      });
      const Lanes grad_sum = grad_hidden * (broadcast(1.0f) - h * h);
      bias = bias + grad_sum;
      store(hidden, grad_sum);
    }
    unroll<OUTPUTS>([&](auto o) HEDON_INLINED { store(gradient + shape.w3() + o * HIDDEN + column, total[o]); });
    store(gradient + shape.b2() + column, bias);
  }
}

/// Backward through C lanes of the first layer, for S samples: adds the derivative of each sample to the rows that it
/// read. A row that all of them read is loaded and stored once; sums are always in the order of the samples.
template <int S, int C>
HEDON_INLINE void add_to_rows(const NetworkShape& shape, const PackedObservation* const* observation,
                              const float* grad_sum, float* gradient) {
  const ObservationShape& sizes = shape.observation;
  Lanes by[S][C];
  Lanes total[C];
  const auto load_row = [&](const float* row) HEDON_INLINED {
    unroll<C>([&](auto c) HEDON_INLINED { total[c] = load(row + c * LANES); });
  };
  const auto add = [&](auto s, float x) HEDON_INLINED {
    unroll<C>([&](auto c) HEDON_INLINED { total[c] = multiply_add(broadcast(x), by[s][c], total[c]); });
  };
  const auto store_row = [&](float* row) HEDON_INLINED {
    unroll<C>([&](auto c) HEDON_INLINED { store(row + c * LANES, total[c]); });
  };
  const auto add_one = [&](float* row, auto s, float x) HEDON_INLINED {
    load_row(row);
    add(s, x);
    store_row(row);
  };
  const auto add_all = [&](float* row, const auto& entry) HEDON_INLINED {
    load_row(row);
    unroll<S>([&](auto s) HEDON_INLINED { add(s, entry(*observation[s])); });
    store_row(row);
  };

  unroll<S>([&](auto s) HEDON_INLINED {
    unroll<C>([&](auto c) HEDON_INLINED { by[s][c] = load(grad_sum + s * HIDDEN + c * LANES); });
  });
  float* const w1 = gradient + shape.w1();
  for (int32_t r = 0; r < sizes.rays; ++r) {
    if (same_type<S>(observation, r)) {
      add_all(w1 + sizes.ray_entry(r, observation[0]->ray_type[r]) * HIDDEN,
              [&](const PackedObservation& seen) HEDON_INLINED { return seen.ray[r]; });
    } else {
      unroll<S>([&](auto s) HEDON_INLINED {
        add_one(w1 + sizes.ray_entry(r, observation[s]->ray_type[r]) * HIDDEN, s, observation[s]->ray[r]);
      });
    }
  }
  float* row = w1 + sizes.ray_entries() * HIDDEN;
  unroll<S>([&](auto s) HEDON_INLINED {
    for (uint64_t bits = observation[s]->touch; bits != 0; bits &= bits - 1) {
      add_one(row + lowest_bit(bits) * HIDDEN, s, 1.0f);
    }
    if (!sizes.wide()) return;
    for (uint64_t bits = extra_of(*observation[s]).touch; bits != 0; bits &= bits - 1) {
      add_one(row + (64 + lowest_bit(bits)) * HIDDEN, s, 1.0f);
    }
  });
  row += sizes.touches * HIDDEN;
  for (int32_t d = 0; d < sizes.narrow_dense(); ++d, row += HIDDEN) {
    add_all(row, [&](const PackedObservation& seen) HEDON_INLINED { return seen.dense[d]; });
  }
  for (int32_t d = MAX_DENSE; d < sizes.dense; ++d, row += HIDDEN) {
    add_all(row, [&](const PackedObservation& seen) HEDON_INLINED { return extra_of(seen).dense[d - MAX_DENSE]; });
  }
  add_all(gradient + shape.b1(), [](const PackedObservation&) HEDON_INLINED { return 1.0f; });
}

/// Backward through the first layer for a block.
template <class Shape>
HEDON_INLINE void first_layer_backward(const NetworkShape& shape, const PackedObservation* const* observation,
                                       int count, const float* grad_sum, float* gradient) {
  constexpr int S = Shape::row_samples;
  constexpr int C = Shape::row_lanes;
  int s = 0;
  for (; s + S <= count; s += S) {
    for (int column = 0; column < HIDDEN; column += C * LANES) {
      add_to_rows<S, C>(shape, observation + s, grad_sum + s * HIDDEN + column, gradient + column);
    }
  }
  for (; s < count; ++s) add_to_rows<1, WIDTH>(shape, observation + s, grad_sum + s * HIDDEN, gradient);
}

/// Forward, loss and backward of one block of at most BLOCK samples.
template <class Shape>
HEDON_INLINE void gradient_of_block(const NetworkShape& shape, const float* params, const PpoBatch& batch,
                                    const int32_t* order, int count, float share, const LossConstants& constants,
                                    const PpoScratch& memory, float* gradient, LossSums& sums) {
  BlockSamples block;
  const PackedObservation* observation[BLOCK];
  gather(shape.observation, batch, order, count, share, block, observation);

  const PlainRows w1 = {params + shape.w1()};
  int s = 0;
  for (; s + Shape::samples <= count; s += Shape::samples) {
    first_layer<Shape::samples>(shape, w1, memory.folded_bias, observation + s, memory.hidden1 + s * HIDDEN);
  }
  for (; s < count; ++s) first_layer<1>(shape, w1, memory.folded_bias, observation + s, memory.hidden1 + s * HIDDEN);
  second_layer<Shape>(shape, params, memory.hidden1, count, memory.hidden2);
  const int padded = (count + LANES - 1) / LANES * LANES;
  for (s = 0; s < padded; ++s) {
    float output[OUTPUTS];
    heads(shape, params, memory.hidden2 + (s < count ? s : count - 1) * HIDDEN, output);
    unroll<OUTPUTS>([&](auto o) HEDON_INLINED { block.output[o][s] = output[o]; });
  }

  for (s = 0; s < padded; s += LANES) loss_of_lanes(constants, block, s, sums);

  heads_backward(shape, params, block, count, memory.hidden2, gradient);
  float* const w2 = gradient + shape.w2();
  multiply<Shape::rows, Shape::lanes, 1, HIDDEN>(
      memory.hidden1, PlainRows{memory.hidden2}, HIDDEN, count,
      [&](int row, int column) HEDON_INLINED { return load(w2 + row * HIDDEN + column); },
      [&](int row, int column, Lanes total) HEDON_INLINED { store(w2 + row * HIDDEN + column, total); });
  // Each tile reads and writes its own part of hidden1, which is not needed elsewhere after this.
  multiply<Shape::rows, Shape::lanes, HIDDEN, 1>(
      memory.hidden2, PlainRows{memory.w2_transposed}, count, HIDDEN,
      [&](int, int) HEDON_INLINED { return broadcast(0.0f); },
      [&](int row, int column, Lanes total) HEDON_INLINED {
        float* const at = memory.hidden1 + row * HIDDEN + column;
        const Lanes h = load(at);
        store(at, total * (broadcast(1.0f) - h * h));
      });
  first_layer_backward<Shape>(shape, observation, count, memory.hidden1, gradient);
}

/// Loss and gradient of one minibatch; see `NetworkKernels::gradient`.
template <class Shape>
HEDON_FN PpoLoss gradient_of_minibatch(const NetworkShape& shape, const LearningConfig& config, const float* params,
                                       const PpoBatch& batch, const int32_t* order, float* scratch, float* gradient) {
  const PpoScratch memory = split_scratch(scratch);
  fold_bias(shape, params + shape.b1(), PlainRows{params + shape.w1()}, memory.folded_bias);
  transpose(params + shape.w2(), HIDDEN, memory.w2_transposed);
  for (int32_t i = 0; i < shape.size(); i += LANES) store(gradient + i, broadcast(0.0f));

  const int32_t size = config.minibatch_size;
  const float share = 1.0f / static_cast<float>(size);
  const float* const log_sd = params + shape.log_sd();
  alignas(64) float sd_inverse[LANES] = {-log_sd[0], -log_sd[1]};
  store(sd_inverse, exp_lanes(load(sd_inverse)));
  float target_mean = 0.0f;
  if (config.critic_target == LearningCriticTarget::batch_mean) {
    for (int32_t i = 0; i < size; ++i) target_mean += batch.target[order[i]];
    target_mean *= share;
  }
  const LossConstants constants = make_loss_constants(config, log_sd, sd_inverse, target_mean);
  LossSums sums = zero_sums();
  for (int32_t first = 0; first < size; first += BLOCK) {
    const int count = size - first < BLOCK ? size - first : BLOCK;
    gradient_of_block<Shape>(shape, params, batch, order + first, count, share, constants, memory, gradient, sums);
  }

  // The -1 of the rays: x = x' - 1, so subtract the sum of the derivatives (the bias's gradient) from each of their
  // rows.
  for (int32_t row = 0; row < shape.observation.ray_entries(); ++row) {
    unroll<WIDTH>([&](auto c) HEDON_INLINED {
      float* const at = gradient + row * HIDDEN + c * LANES;
      store(at, load(at) - load(gradient + shape.b1() + c * LANES));
    });
  }
  unroll<OUTPUTS>([&](auto o) HEDON_INLINED { gradient[shape.b3() + o] = sum(sums.bias[o]); });
  unroll<ACTIONS>([&](auto d)
                      HEDON_INLINED { gradient[shape.log_sd() + d] = sum(sums.log_sd[d]) - config.entropy_coef; });
  const float entropy = log_sd[0] + log_sd[1] + ACTIONS * 0.5f + LOG_TWO_PI;
  return {sum(sums.policy), sum(sums.value), entropy};
}

}  // namespace
}  // namespace hedon
