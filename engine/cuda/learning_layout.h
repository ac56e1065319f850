/// The layout of an update in the shared memory of its block.
#pragma once

#include "cuda/variant.h"
#include "kernel/ppo_scratch.h"
#include "learning/network.h"

namespace hedon {

/// Shared memory that a block can have, of compute capability 9.0 [floats]: 227 KiB. Source: CUDA C++ Programming
/// Guide, table of technical specifications.
inline constexpr int32_t SHARED_FLOATS = 227 * 1024 / 4;

/// From one row of a hidden layer to the next [floats]. Four more than a row, so that neighboring rows begin in
/// different banks.
inline constexpr int32_t HIDDEN_STRIDE = HIDDEN + 4;

/// Moments of Adam that an update keeps there at most.
inline constexpr int32_t SHARED_MOMENTS = VARIANT.moments;

/// The places of parameters in shared memory. In a compact layout, rows of the square layer are HIDDEN_STRIDE apart, so
/// that threads read columns as fast as rows. Its gradient is in registers until the samples are done, then takes the
/// place of the second hidden layer.
inline constexpr bool COMPACT = VARIANT.compact;
inline constexpr int32_t SQUARE_STRIDE = COMPACT ? HIDDEN_STRIDE : HIDDEN;
inline constexpr int32_t PARAM_SHIFT = (SQUARE_STRIDE - HIDDEN) * HIDDEN;  ///< of parameters after the square layer
inline constexpr int32_t GRADIENT_SHIFT = COMPACT ? -HIDDEN * HIDDEN : 0;  ///< the same of the gradient
static_assert(!COMPACT || SHARED_MOMENTS == 0, "moments in shared memory have the places of the network");

/// Sums of the loss over a minibatch: the bias of each output, and the log-sd of each action.
inline constexpr int32_t LOSS_SUMS = OUTPUTS + ACTIONS;
inline constexpr int32_t SAMPLE_ARRAYS = OUTPUTS + ACTIONS + 4;  ///< of a `BlockSamples`

/// Places in shared memory [floats]; -1 for a moment of Adam that stays in global memory, since it does not fit.
struct LearningLayout {
  int32_t params, gradient, first_moment, second_moment;
  int32_t w2_transposed;     ///< (64, 64), unless the layout is compact
  int32_t hidden1, hidden2;  ///< (64 samples, HIDDEN_STRIDE)
  int32_t folded_bias;       ///< (64)
  int32_t samples;           ///< `BlockSamples`
  int32_t parts;             ///< (LOSS_SUMS, 64 samples)
  int32_t sums;              ///< (LOSS_SUMS, 16)
  int32_t index;             ///< (64) the steps of the samples
  int32_t total;

  HEDON_FN constexpr bool fits() const { return total <= SHARED_FLOATS; }
};

/// The layout for a network of `size` parameters with `moments` (0, 1 or 2) of them in shared memory.
HEDON_FN constexpr LearningLayout learning_layout(int32_t size, int32_t moments) {
  LearningLayout at{};
  int32_t next = 0;
  const auto take = [&](int32_t& place, int32_t floats) {
    place = next;
    next += floats;
  };
  take(at.params, size + PARAM_SHIFT);
  take(at.gradient, size + GRADIENT_SHIFT);
  at.first_moment = at.second_moment = -1;
  if (moments > 0) take(at.first_moment, size);
  if (moments > 1) take(at.second_moment, size);
  take(at.w2_transposed, COMPACT ? 0 : HIDDEN * HIDDEN);
  take(at.hidden1, BLOCK * HIDDEN_STRIDE);
  take(at.hidden2, BLOCK * HIDDEN_STRIDE);
  take(at.folded_bias, HIDDEN);
  take(at.samples, SAMPLE_ARRAYS * BLOCK);
  take(at.parts, LOSS_SUMS * BLOCK);
  take(at.sums, LOSS_SUMS * 16);
  take(at.index, BLOCK);
  at.total = next;
  return at;
}

/// The same with as many moments as fit and the variant wants; `fits` is false if not even a network without them does.
HEDON_FN constexpr LearningLayout learning_layout(int32_t size) {
  for (int32_t moments = SHARED_MOMENTS; moments > 0; --moments) {
    const LearningLayout at = learning_layout(size, moments);
    if (at.total <= SHARED_FLOATS) return at;
  }
  return learning_layout(size, 0);
}

/// Parameters of a network with this many inputs; the least number of inputs that an update cannot hold.
constexpr int32_t params_of(int32_t inputs) { return NetworkShape{{0, 0, 0, inputs, NARROW_LINES}}.size(); }
constexpr int32_t first_too_wide() {
  int32_t inputs = 1;
  while (learning_layout(params_of(inputs)).total <= SHARED_FLOATS) ++inputs;
  return inputs;
}
inline constexpr int32_t WIDEST_NETWORK = first_too_wide() - 1;  ///< inputs

// The widths of the presets: one species; poison; predators.
static_assert(COMPACT || learning_layout(params_of(95), 2).fits(), "an update of 95 inputs fits with both moments");
static_assert(COMPACT || learning_layout(params_of(125), 1).fits(), "an update of 125 inputs fits with one moment");
static_assert(
    VARIANT.learners * (learning_layout(params_of(95)).total + 256) <= SHARED_FLOATS + 256,
    "as many updates of 95 inputs as the variant says fit a multiprocessor, with 1 KiB that each block takes");
static_assert(WIDEST_NETWORK >= 205, "an update of 205 inputs fits without moments");

}  // namespace hedon
