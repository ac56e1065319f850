/// The experience of one learner in a window, and the order of its minibatches.
#pragma once

#include <cstdint>

#include "base/random.h"
#include "learning/observation.h"

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

/// Sorts the steps of each minibatch of a permutation by time. The minibatch of a step stays random, but neighboring
/// steps have similar observations, which makes the kernels faster.
/// owner, end   (count) scratch
HEDON_FN void sort_minibatches(int32_t count, int32_t minibatch_size, int32_t* owner, int32_t* end, int32_t* order) {
  for (int32_t first = 0, batch = 0; first < count; first += minibatch_size, ++batch) {
    for (int32_t i = first; i < first + minibatch_size; ++i) owner[order[i]] = batch;
    end[batch] = first;
  }
  for (int32_t step = 0; step < count; ++step) order[end[owner[step]]++] = step;
}

}  // namespace hedon
