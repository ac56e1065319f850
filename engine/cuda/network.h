/// Computes the weights with which agents act from their parameters, with any number of threads.
#pragma once

#include "cuda/block.h"
#include "learning/network.h"
#include "learning/weight_pair.h"

namespace hedon {

/// A single thread, for the serial part of a step.
struct OneThread {
  template <class Body>
  HEDON_INLINE void each(int count, Body&& body) const {
    for (int i = 0; i < count; ++i) body(i);
  }
  HEDON_INLINE void barrier() const {}
};

/// See `ActingNetwork::folded_bias`: ray by ray, in the order of the CPU's kernels. read(row, unit) gives a weight.
template <class Group, class Read>
HEDON_FN void fold_bias_by(const Group& group, const NetworkShape& shape, const float* b1, float* folded, Read&& read) {
  const ObservationShape& sizes = shape.observation;
  group.each(HIDDEN, [&](int unit) {
    float bias = b1[unit];
    for (int32_t r = 0; r < sizes.rays; ++r) {
      for (int32_t type = 0; type < sizes.types; ++type) bias = bias - read(sizes.ray_entry(r, type), unit);
    }
    folded[unit] = bias;
  });
}

/// The weight of a unit in a row of pairs: see `PackedRows`.
HEDON_FN float unpack_weight(const float* packed, int32_t row, int unit) {
  const float pair = packed[row * (HIDDEN / 2) + unit / 32 * 16 + unit % 16];
  if (unit % 32 < 16) return pair;
  uint32_t bits;
  memcpy(&bits, &pair, sizeof bits);
  bits <<= 16;
  float second;
  memcpy(&second, &bits, sizeof second);
  return second;
}

/// See `NetworkKernels::pack_weights`. params   of the network, possibly in shared memory
template <class Group>
HEDON_FN void pack_weights_by(const Group& group, const NetworkShape& shape, const float* params,
                              const ActingNetwork& network) {
  const float* const b1 = params + shape.b1();
  if (network.packed_weights == nullptr) {
    fold_bias_by(group, shape, b1, network.folded_bias,
                 [&](int32_t row, int unit) { return params[row * HIDDEN + unit]; });
    return;
  }
  group.each(shape.pairs(), [&](int pair) {
    const float* const first = params + pair / 16 * 32 + pair % 16;
    network.packed_weights[pair] = pair_weights(first[0], first[16]);
  });
  group.barrier();
  fold_bias_by(group, shape, b1, network.folded_bias,
               [&](int32_t row, int unit) { return unpack_weight(network.packed_weights, row, unit); });
}

/// The `NetworkKernels::pack_weights` that a birth calls.
HEDON_FN void pack_weights_alone(const NetworkShape& shape, const ActingNetwork& network) {
  pack_weights_by(OneThread{}, shape, network.params, network);
}

}  // namespace hedon
