/// The initial parameters of a network.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/random.h"
#include "learning/network.h"

namespace hedon {

inline constexpr float MEAN_HEAD_GAIN = 0.01f;  ///< small, so that a new policy hardly depends on observations

/// Draws from a stream, one after another.
struct DrawSequence {
  RandomStream stream;
  uint32_t next;

  /// Uniform in [-limit, limit).
  HEDON_FN void uniform(float limit, int32_t count, float* out) {
    for (int32_t i = 0; i < count; i += 4) {
      const Random4 draw = stream.draw(next++);
      for (int32_t k = 0; k < 4 && i + k < count; ++k) out[i + k] = limit * (2.0f * to_uniform(draw.word[k]) - 1.0f);
    }
  }

  /// Standard normal; `count` is a multiple of 4.
  HEDON_FN void normal(int32_t count, float* out) {
    for (int32_t i = 0; i < count; i += 4) {
      const Random4 draw = stream.draw(next++);
      const NormalPair low = to_normal(draw.word[0], draw.word[1]);
      const NormalPair high = to_normal(draw.word[2], draw.word[3]);
      out[i] = low.first;
      out[i + 1] = low.second;
      out[i + 2] = high.first;
      out[i + 3] = high.second;
    }
  }
};

/// Makes the rows of an (ACTIONS, HIDDEN) matrix orthogonal to each other and of length `gain` (Gram and Schmidt).
HEDON_FN void orthogonalize(float gain, float* rows) {
  for (int a = 0; a < ACTIONS; ++a) {
    float* const row = rows + a * HIDDEN;
    for (int b = 0; b < a; ++b) {
      const float* const other = rows + b * HIDDEN;
      double along = 0.0;
      for (int i = 0; i < HIDDEN; ++i) along += static_cast<double>(row[i]) * other[i];
      along /= static_cast<double>(gain) * gain;
      for (int i = 0; i < HIDDEN; ++i) row[i] = static_cast<float>(row[i] - along * other[i]);
    }
    double squared = 0.0;
    for (int i = 0; i < HIDDEN; ++i) squared += static_cast<double>(row[i]) * row[i];
    const double scale = gain / sqrt(squared);
    for (int i = 0; i < HIDDEN; ++i) row[i] = static_cast<float>(row[i] * scale);
  }
}

/// Initial parameters: weights and biases uniform within ±1/sqrt(inputs of the layer), the mean head's weights
/// orthogonal, log-sd 0. `params` has `shape.size()` floats.
HEDON_FN void init_network(const NetworkShape& shape, const RandomStream& stream, float* params) {
  DrawSequence draws{stream, 0};
  const ObservationShape& sizes = shape.observation;
  const int32_t inputs = sizes.size();
  const float first = 1.0f / sqrtf(static_cast<float>(inputs));
  const float later = 1.0f / sqrtf(static_cast<float>(HIDDEN));
  float* const w1 = params + shape.w1();
  // Ray by ray, not row by row, so that the draw of an entry does not depend on the place of its row in memory.
  for (int32_t r = 0; r < sizes.rays; ++r) {
    for (int32_t type = 0; type < sizes.types; ++type) {
      draws.uniform(first, HIDDEN, w1 + sizes.ray_entry(r, type) * HIDDEN);
    }
  }
  draws.uniform(first, (inputs - sizes.ray_entries()) * HIDDEN, w1 + sizes.ray_entries() * HIDDEN);
  draws.uniform(first, HIDDEN, params + shape.b1());
  draws.uniform(later, HIDDEN * HIDDEN, params + shape.w2());
  draws.uniform(later, HIDDEN, params + shape.b2());
  draws.normal(ACTIONS * HIDDEN, params + shape.w3());
  orthogonalize(MEAN_HEAD_GAIN, params + shape.w3());
  draws.uniform(later, HIDDEN, params + shape.w3() + ACTIONS * HIDDEN);
  draws.uniform(later, OUTPUTS, params + shape.b3());
  for (int32_t i = shape.log_sd(); i < shape.size(); ++i) params[i] = 0.0f;
}

}  // namespace hedon
