/// The loss of 64 samples and its gradient. The same sums in the same order as `kernel/ppo_gradient.h`.
#pragma once

#include "cuda/learner.h"

namespace hedon {
namespace {

/// The loss of the samples by tiles of 16 threads: outputs become derivatives, and each sample's parts of the sums.
HEDON_FN void loss_by_block(const Block& block, const BlockUpdate& on, const LossConstants& constants, int padded) {
  for (int i = block.tile(); i < padded / TILE; i += block.tiles()) {
    const int first = i * TILE;
    LossSums sums = zero_sums();
    loss_of_lanes(constants, *on.samples, first, sums);
    for (int o = 0; o < OUTPUTS; ++o) store(on.parts + o * BLOCK + first, sums.bias[o]);
    for (int a = 0; a < ACTIONS; ++a) store(on.parts + (OUTPUTS + a) * BLOCK + first, sums.log_sd[a]);
  }
}

/// Adds the parts to the sums, lane by lane in the order of the samples; backward through the heads: their weights.
HEDON_FN void heads_backward_by_block(const Block& block, const BlockUpdate& on, int count, int padded) {
  block.each(LOSS_SUMS * TILE, [&](int task) {
    const int sum = task / TILE, lane = task % TILE;
    float total = on.sums[task];
    for (int s = lane; s < padded; s += TILE) total = total + on.parts[sum * BLOCK + s];
    on.sums[task] = total;
  });
  block.each(OUTPUTS * HIDDEN, [&](int task) {
    const int output = task / HIDDEN, unit = task % HIDDEN;
    float* const to = on.gradient_after(on.shape.w3() + task);
    float total = *to;
    for (int s = 0; s < count; ++s)
      total = __builtin_fmaf(on.samples->output[output][s], on.hidden2[s * HIDDEN_STRIDE + unit], total);
    *to = total;
  });
}

/// Replaces the second hidden layer by the derivatives of its sums.
HEDON_FN void second_layer_backward_by_block(const Block& block, const BlockUpdate& on) {
  block.each(BLOCK * HIDDEN / 4, [&](int task) {
    const int sample = task / 16, unit = task % 16 * 4;
    Four h = read_four(on.hidden2 + sample * HIDDEN_STRIDE + unit);
    const float* const weight = on.param_after(on.shape.w3() + unit);
    for (int j = 0; j < 4; ++j) {
      float slope = on.samples->output[0][sample] * weight[j];
      for (int o = 1; o < OUTPUTS; ++o)
        slope = __builtin_fmaf(on.samples->output[o][sample], weight[o * HIDDEN + j], slope);
      h.v[j] = slope * (1.0f - h.v[j] * h.v[j]);
    }
    write_four(on.hidden2 + sample * HIDDEN_STRIDE + unit, h);
  });
}

/// Adds to the gradients of the square layer and of its bias.
/// own   the thread's part of the first, if the layout is compact
HEDON_INLINE void square_gradient_by_block(const Block& block, const BlockUpdate& on, int count, OwnTiles& own) {
  const auto add_samples = [&](Totals& total, int from, int unit) {
    for (int s = 0; s < count; ++s) {
      const Column left = read_column(on.hidden1 + s * HIDDEN_STRIDE + from);
      const Four right = read_four(on.hidden2 + s * HIDDEN_STRIDE + unit);
      for (int i = 0; i < TILE_ROWS; ++i) total.add(i, left.v[i], right);
    }
  };
  if constexpr (COMPACT) {
    own.each(block, add_samples);
  } else {
    each_tile(block, [&](int from, int unit) {
      float* const to = on.gradient + on.shape.w2() + from * HIDDEN + unit;
      Totals total;
      for (int i = 0; i < TILE_ROWS; ++i) total.set_row(i, read_four(to + i * HIDDEN));
      add_samples(total, from, unit);
      for (int i = 0; i < TILE_ROWS; ++i) write_four(to + i * HIDDEN, total.row(i));
    });
  }
  block.each(HIDDEN, [&](int unit) {
    float* const to = on.gradient_after(on.shape.b2() + unit);
    float total = *to;
    for (int s = 0; s < count; ++s) total = total + on.hidden2[s * HIDDEN_STRIDE + unit];
    *to = total;
  });
}

/// Replaces the first hidden layer by the derivatives of its sums.
HEDON_FN void hidden_backward_by_block(const Block& block, const BlockUpdate& on) {
  each_tile(block, [&](int sample, int unit) {
    const float* const slopes = on.hidden2 + sample * HIDDEN_STRIDE;
    float* const to = on.hidden1 + sample * HIDDEN_STRIDE;
    Totals total{};
    if constexpr (COMPACT) {
      const int first = unit / 4;
      multiply_columns(slopes, on.params() + on.shape.w2() + first * SQUARE_STRIDE, total);
      for (int i = 0; i < TILE_ROWS; ++i) {
        for (int j = 0; j < 4; ++j) {
          float& h = to[i * HIDDEN_STRIDE + first + j * 16];
          h = total.v[i][j] * (1.0f - h * h);
        }
      }
    } else {
      multiply_rows<HIDDEN>(slopes, on.w2_transposed + unit, total);
      for (int i = 0; i < TILE_ROWS; ++i) {
        Four h = read_four(to + i * HIDDEN_STRIDE + unit);
        for (int j = 0; j < 4; ++j) h.v[j] = total.v[i][j] * (1.0f - h.v[j] * h.v[j]);
        write_four(to + i * HIDDEN_STRIDE + unit, h);
      }
    }
  });
}

/// Adds x times the derivatives of a sample to a row of the first layer's gradient, 4 units of it. Holds the row until
/// a different one is needed.
struct RowSum {
  float* gradient;  ///< of the first of the 4 units
  const float* slopes;
  int32_t row = -1;
  Four total;

  HEDON_INLINE void add(int32_t to, int sample, float x) {
    if (to != row) {
      finish();
      row = to;
      total = read_four(gradient + row * HIDDEN);
    }
    const Four slope = read_four(slopes + sample * HIDDEN_STRIDE);
    for (int j = 0; j < 4; ++j) total.v[j] = __builtin_fmaf(x, slope.v[j], total.v[j]);
  }
  HEDON_INLINE void finish() const {
    if (row >= 0) write_four(gradient + row * HIDDEN, total);
  }
};

/// Backward through the first layer. A thread has 4 units of one ray, of one dense entry, of the bias, or of touch;
/// each kind has a loop over the samples of its own.
HEDON_FN void first_layer_backward_by_block(const Block& block, const BlockUpdate& on,
                                            const PackedObservation* observation, int count) {
  const ObservationShape& sizes = on.shape.observation;
  const int32_t touch = sizes.ray_entries(), dense = touch + sizes.touches;
  block.each((sizes.rays + sizes.dense + 2) * 16, [&](int task) {
    const int input = task / 16, unit = task % 16 * 4;
    const int32_t d = input - sizes.rays;
    RowSum sum{on.gradient + unit, on.hidden1 + unit, -1, {}};
    const auto seen = [&](int s) -> const PackedObservation& {
      return *observation_at(sizes, observation, on.index[s]);
    };
    if (d < 0) {
      for (int s = 0; s < count; ++s) sum.add(sizes.ray_entry(input, seen(s).ray_type[input]), s, seen(s).ray[input]);
    } else if (d < sizes.dense && d < MAX_DENSE) {
      for (int s = 0; s < count; ++s) sum.add(dense + d, s, seen(s).dense[d]);
    } else if (d < sizes.dense) {
      for (int s = 0; s < count; ++s) sum.add(dense + d, s, extra_of(seen(s)).dense[d - MAX_DENSE]);
    } else if (d == sizes.dense) {
      for (int s = 0; s < count; ++s) sum.add(sizes.size(), s, 1.0f);  // the bias is the row after the inputs
    } else {
      const auto add_touched = [&](uint64_t touched, int32_t first, int s) {
        for (uint64_t bits = touched; bits != 0; bits &= bits - 1) sum.add(first + lowest_bit(bits), s, 1.0f);
      };
      for (int s = 0; s < count; ++s) {
        add_touched(seen(s).touch, touch, s);
        if (sizes.wide()) add_touched(extra_of(seen(s)).touch, touch + 64, s);
      }
    }
    sum.finish();
  });
}

}  // namespace
}  // namespace hedon
