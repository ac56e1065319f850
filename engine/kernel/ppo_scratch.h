/// How an update divides its scratch memory.
#pragma once

#include "base/device.h"
#include "learning/network.h"

namespace hedon {

inline constexpr int BLOCK = 64;  ///< samples that go through the network together

/// Parts of the scratch memory, each a multiple of 16 floats.
struct PpoScratch {
  float* folded_bias;    ///< (64), the first bias with the -1 of the rays folded_bias in
  float* w2_transposed;  ///< (64, 64)
  float* hidden1;        ///< (BLOCK, 64); later the derivative of the loss with respect to the first layer's sums
  float* hidden2;        ///< (BLOCK, 64); the same for the second layer
  float* gradient;       ///< (size)
};

HEDON_INLINE PpoScratch split_scratch(float* scratch) {
  float* const w2_transposed = scratch + HIDDEN;
  float* const hidden1 = w2_transposed + HIDDEN * HIDDEN;
  float* const hidden2 = hidden1 + BLOCK * HIDDEN;
  return {scratch, w2_transposed, hidden1, hidden2, hidden2 + BLOCK * HIDDEN};
}

/// Floats of scratch that `gradient` and `update` need, aligned to 64 bytes.
HEDON_INLINE int64_t ppo_scratch_size(const NetworkShape& shape) {
  return HIDDEN + HIDDEN * HIDDEN + 2 * BLOCK * HIDDEN + shape.size();
}

}  // namespace hedon
