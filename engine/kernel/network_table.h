/// The kernels of networks: acting, and learning.
#pragma once

#include <cstdint>

#include "config/schema.h"
#include "learning/network.h"
#include "learning/observation.h"

namespace hedon {

/// One learner's rollout of `count` steps, and the order of its minibatches.
struct PpoBatch {
  const PackedObservation* observation;  ///< (count)
  const float* action;                   ///< (count, 2), before the sigmoid
  const float* log_prob;                 ///< (count), of the joint action under the policy that acted
  const float* advantage;                ///< (count)
  const float* target;                   ///< (count), of the value
  const int32_t* order;                  ///< (update_epochs, count), a permutation of the steps per epoch
  int32_t count;                         ///< a multiple of minibatch_size
};

/// One learner's parameters and Adam state, each of `NetworkShape::size()` floats, aligned to 64 bytes.
struct Learner {
  float* params;
  float* first_moment;
  float* second_moment;
  int64_t* updates;  ///< Adam steps done so far in this life
};

/// Means over one minibatch: what one update saw.
struct PpoLoss {
  float policy, value, entropy;
};

struct NetworkKernels {
  /// Pairs the weights, unless `network.packed_weights` is null, and folds the bias. Call it when parameters change.
  void (*pack_weights)(const NetworkShape& shape, const ActingNetwork& network);

  /// Mean (2) and value (1) for one observation.
  void (*forward)(const NetworkShape& shape, const ActingNetwork& network, const PackedObservation& observation,
                  float* output);

  /// Loss and gradient of one minibatch given by `order[0 .. minibatch_size)`; `gradient` has `shape.size()` floats.
  PpoLoss (*gradient)(const NetworkShape& shape, const LearningConfig& config, const float* params,
                      const PpoBatch& batch, const int32_t* order, float* scratch, float* gradient);

  /// One Adam step on `size` parameters.
  void (*adam)(const LearningConfig& config, int32_t size, const float* gradient, const Learner& learner);

  /// All epochs and minibatches of one learner; returns the means of the last epoch.
  PpoLoss (*update)(const NetworkShape& shape, const LearningConfig& config, const PpoBatch& batch, float* scratch,
                    const Learner& learner);
};

}  // namespace hedon
