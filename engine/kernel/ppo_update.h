/// One learner's update: all epochs and minibatches, each a gradient and an Adam step.
#pragma once

#include "kernel/ppo_gradient.h"

namespace hedon {
namespace {

/// base^exponent, by repeated squaring.
HEDON_INLINE double power(double base, int64_t exponent) {
  double result = 1.0;
  for (; exponent > 0; exponent >>= 1, base *= base) {
    if (exponent & 1) result *= base;
  }
  return result;
}

/// Below this, a moment is set to 0. It has no effect any more, and would become a denormal number, which some
/// processors flush to zero and others compute slowly. NaN stays NaN.
constexpr float SMALLEST_MOMENT = 1e-30f;

HEDON_INLINE Lanes without_tiny(Lanes moment) {
  const Lanes limit = broadcast(SMALLEST_MOMENT);
  return select(both(moment <= limit, broadcast(-SMALLEST_MOMENT) <= moment), broadcast(0.0f), moment);
}

/// What all parameters share in one Adam step.
struct AdamStep {
  Lanes rate, root_scale, epsilon;
  Lanes beta1, beta2, rest1, rest2;
};

/// number   of the step in the learner's life, from 1
HEDON_INLINE AdamStep make_adam_step(const LearningConfig& config, int64_t number) {
  const double correction1 = 1.0 - power(config.adam_beta1, number);
  const double correction2 = 1.0 - power(config.adam_beta2, number);
  return {broadcast(static_cast<float>(-config.learning_rate / correction1)),
          broadcast(static_cast<float>(__builtin_sqrt(1.0 / correction2))),
          broadcast(config.adam_epsilon),
          broadcast(config.adam_beta1),
          broadcast(config.adam_beta2),
          broadcast(1.0f - config.adam_beta1),
          broadcast(1.0f - config.adam_beta2)};
}

/// 16 parameters from `i` on: p -= rate · m̂ / (sqrt(v̂) + ε). Source: Kingma and Ba (2015), algorithm 1.
HEDON_INLINE void adam_lanes(const AdamStep& step, int32_t i, const float* gradient, const Learner& learner) {
  const Lanes g = load(gradient + i);
  const Lanes m = without_tiny(multiply_add(step.beta1, load(learner.first_moment + i), step.rest1 * g));
  const Lanes v = without_tiny(multiply_add(step.beta2, load(learner.second_moment + i), step.rest2 * g * g));
  store(learner.first_moment + i, m);
  store(learner.second_moment + i, v);
  const Lanes divisor = multiply_add(square_root(v), step.root_scale, step.epsilon);
  store(learner.params + i, load(learner.params + i) + step.rate * m / divisor);
}

/// One Adam step of all parameters.
HEDON_FN void adam(const LearningConfig& config, int32_t size, const float* gradient, const Learner& learner) {
  const AdamStep step = make_adam_step(config, ++*learner.updates);
  for (int32_t i = 0; i < size; i += LANES) adam_lanes(step, i, gradient, learner);
}

/// See `NetworkKernels::update`.
template <class Shape>
HEDON_FN PpoLoss update(const NetworkShape& shape, const LearningConfig& config, const PpoBatch& batch, float* scratch,
                        const Learner& learner) {
  float* const gradient = split_scratch(scratch).gradient;
  const int32_t minibatches = batch.count / config.minibatch_size;
  PpoLoss mean = {0.0f, 0.0f, 0.0f};
  for (int32_t epoch = 0; epoch < config.update_epochs; ++epoch) {
    mean = {0.0f, 0.0f, 0.0f};
    for (int32_t i = 0; i < minibatches; ++i) {
      const int32_t* order = batch.order + static_cast<int64_t>(epoch) * batch.count + i * config.minibatch_size;
      const PpoLoss loss = gradient_of_minibatch<Shape>(shape, config, learner.params, batch, order, scratch, gradient);
      adam(config, shape.size(), gradient, learner);
      mean.policy += loss.policy;
      mean.value += loss.value;
      mean.entropy += loss.entropy;
    }
  }
  const float share = minibatches > 0 ? 1.0f / static_cast<float>(minibatches) : 0.0f;
  return {mean.policy * share, mean.value * share, mean.entropy * share};
}

}  // namespace
}  // namespace hedon
