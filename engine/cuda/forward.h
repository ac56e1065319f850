/// Forward through the network of a learner, 64 samples at a time. The same sums in the same order as
/// `kernel/network_forward.h`.
#pragma once

#include "cuda/learner.h"

namespace hedon {
namespace {

/// The parts of the loss and of its derivatives that samples need, of the steps `order[0 .. count)`, filled up by the
/// last one with share 0.
HEDON_FN void gather_by_block(const Block& block, const BlockUpdate& on, const PpoBatch& batch, const int32_t* order,
                              int count) {
  const float share = 1.0f / static_cast<float>(on.config.minibatch_size);
  block.each(BLOCK, [&](int s) {
    const int32_t i = order[s < count ? s : count - 1];
    BlockSamples& samples = *on.samples;
    on.index[s] = i;
    samples.action[0][s] = batch.action[ACTIONS * i];
    samples.action[1][s] = batch.action[ACTIONS * i + 1];
    samples.log_prob[s] = batch.log_prob[i];
    samples.advantage[s] = batch.advantage[i];
    samples.target[s] = batch.target[i];
    samples.share[s] = s < count ? share : 0.0f;
  });
}

/// The first hidden layer of the samples.
HEDON_FN void first_layer_by_block(const Block& block, const BlockUpdate& on, const PackedObservation* observation) {
  const ObservationShape& sizes = on.shape.observation;
  const float* const w1 = on.params() + on.shape.w1();
  each_tile(block, [&](int sample, int unit) {
    const PackedObservation* seen[TILE_ROWS];
    Totals total;
    for (int i = 0; i < TILE_ROWS; ++i) {
      seen[i] = observation_at(sizes, observation, on.index[sample + i]);
      total.set_row(i, read_four(on.folded_bias + unit));
    }
    const auto row = [&](int32_t entry) { return read_four(w1 + entry * HIDDEN + unit); };
    for (int32_t r = 0; r < sizes.rays; ++r) {
      int type = seen[0]->ray_type[r];
      Four weights = row(sizes.ray_entry(r, type));
      for (int i = 0; i < TILE_ROWS; ++i) {
        // Neighboring samples mostly agree, so their weights are mostly read once.
        if (seen[i]->ray_type[r] != type) {
          type = seen[i]->ray_type[r];
          weights = row(sizes.ray_entry(r, type));
        }
        total.add(i, seen[i]->ray[r], weights);
      }
    }
    const int32_t touch = sizes.ray_entries(), dense = touch + sizes.touches;
    for (int i = 0; i < TILE_ROWS; ++i) {
      const auto add_touched = [&](uint64_t touched, int32_t first) {
        for (uint64_t bits = touched; bits != 0; bits &= bits - 1) total.add(i, 1.0f, row(first + lowest_bit(bits)));
      };
      add_touched(seen[i]->touch, touch);
      if (sizes.wide()) add_touched(extra_of(*seen[i]).touch, touch + 64);
    }
    for (int32_t d = 0; d < sizes.dense; ++d) {
      const Four weights = row(dense + d);
      for (int i = 0; i < TILE_ROWS; ++i)
        total.add(i, d < MAX_DENSE ? seen[i]->dense[d] : extra_of(*seen[i]).dense[d - MAX_DENSE], weights);
    }
    for (int i = 0; i < TILE_ROWS; ++i) {
      Four out;
      for (int j = 0; j < 4; ++j) out.v[j] = tanh_lanes(Lanes{total.v[i][j]}).v;
      write_four(on.hidden1 + (sample + i) * HIDDEN_STRIDE + unit, out);
    }
  });
}

/// The second hidden layer of the samples.
HEDON_FN void second_layer_by_block(const Block& block, const BlockUpdate& on) {
  each_tile(block, [&](int sample, int unit) {
    Totals total;
    for (int i = 0; i < TILE_ROWS; ++i) total.set_row(i, read_four(on.param_after(on.shape.b2()) + unit));
    multiply_rows<SQUARE_STRIDE>(on.hidden1 + sample * HIDDEN_STRIDE, on.params() + on.shape.w2() + unit, total);
    for (int i = 0; i < TILE_ROWS; ++i) {
      Four out;
      for (int j = 0; j < 4; ++j) out.v[j] = tanh_lanes(Lanes{total.v[i][j]}).v;
      write_four(on.hidden2 + (sample + i) * HIDDEN_STRIDE + unit, out);
    }
  });
}

/// Mean and value of the samples: each a sum of 16 lanes, halves onto halves.
HEDON_FN void heads_by_block(const Block& block, const BlockUpdate& on) {
  block.each(OUTPUTS * BLOCK, [&](int task) {
    const int output = task / BLOCK, sample = task % BLOCK;
    const float* const hidden = on.hidden2 + sample * HIDDEN_STRIDE;
    const float* const weight = on.param_after(on.shape.w3()) + output * HIDDEN;
    float lane[16];
    for (int i = 0; i < 16; ++i) lane[i] = hidden[i] * weight[i];
    for (int c = 16; c < HIDDEN; ++c) lane[c % 16] = __builtin_fmaf(hidden[c], weight[c], lane[c % 16]);
    for (int half = 8; half > 0; half /= 2) {
      for (int i = 0; i < half; ++i) lane[i] += lane[i + half];
    }
    on.samples->output[output][sample] = lane[0] + *on.param_after(on.shape.b3() + output);
  });
}

}  // namespace
}  // namespace hedon
