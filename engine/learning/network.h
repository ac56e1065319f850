/// The network of one agent: Linear(inputs, 64)–tanh–Linear(64, 64)–tanh, heads mean (2) and value (1), log-sd (2).
#pragma once

#include <cstdint>

#include "base/device.h"
#include "learning/observation.h"

namespace hedon {

inline constexpr int HIDDEN = 64;
inline constexpr int ACTIONS = 2;
inline constexpr int OUTPUTS = ACTIONS + 1;  ///< mean of each action, then the value

/// The place of each layer in the flat array of an agent's parameters. Weights are stored by input row: `w[in][out]`.
/// The layout is a multiple of 16 floats; the padding is 0 and stays 0.
struct NetworkShape {
  ObservationShape observation;

  constexpr HEDON_INLINE int32_t w1() const { return 0; }                            ///< (inputs, 64)
  constexpr HEDON_INLINE int32_t b1() const { return observation.size() * HIDDEN; }  ///< (64)
  constexpr HEDON_INLINE int32_t w2() const { return b1() + HIDDEN; }                ///< (64, 64)
  constexpr HEDON_INLINE int32_t b2() const { return w2() + HIDDEN * HIDDEN; }       ///< (64)
  constexpr HEDON_INLINE int32_t w3() const { return b2() + HIDDEN; }            ///< (3, 64): by output, not by input
  constexpr HEDON_INLINE int32_t b3() const { return w3() + OUTPUTS * HIDDEN; }  ///< (3)
  constexpr HEDON_INLINE int32_t log_sd() const { return b3() + OUTPUTS; }       ///< (2)
  constexpr HEDON_INLINE int32_t size() const { return b3() + 16; }
  constexpr HEDON_INLINE int32_t pairs() const {
    return b2() / 2;
  }  ///< of all before b2: rows of 64 at the same places as in the parameters; b1 is not used
};

/// The network with which an agent acts: its parameters, and the data that `NetworkKernels::pack_weights` computes.
struct ActingNetwork {
  const float* params;
  float* folded_bias;  ///< (64) b1, less the -1 that all ray channels read: folded_bias[j] = b1[j] - sum of w1[row, j]
                       ///< over rays
  float* packed_weights;  ///< (pairs) w1 and w2 rounded, see `weight_pair.h`; null if agents act with the parameters
};

}  // namespace hedon
