/// Counter-based random numbers: every draw is a function of (seed, purpose, id, step, index) only.
///
/// So results do not depend on threads or on the order of loops, and a checkpoint needs no generator state.
/// Source: Salmon et al. (2011), "Parallel random numbers: as easy as 1, 2, 3", Philox4x32-10.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/device.h"
#include "base/math.h"

namespace hedon {

struct Random4 {
  uint32_t word[4];
};

/// Philox4x32 with 10 rounds.
HEDON_FN Random4 philox(Random4 counter, uint32_t key0, uint32_t key1) {
  for (int round = 0; round < 10; ++round) {
    const uint64_t a = static_cast<uint64_t>(0xD2511F53u) * counter.word[0];
    const uint64_t b = static_cast<uint64_t>(0xCD9E8D57u) * counter.word[2];
    counter = {{static_cast<uint32_t>(b >> 32) ^ counter.word[1] ^ key0, static_cast<uint32_t>(b),
                static_cast<uint32_t>(a >> 32) ^ counter.word[3] ^ key1, static_cast<uint32_t>(a)}};
    key0 += 0x9E3779B9u;
    key1 += 0xBB67AE85u;
  }
  return counter;
}

/// What a draw is for. Results depend on these numbers: append new ones, never renumber.
enum class Purpose : uint32_t {
  action = 0,
  life_and_death = 1,
  parent_order = 2,
  child_place = 3,
  child_heading = 4,
  mutation = 5,
  initial_genome = 6,
  initial_place = 7,
  network = 8,
  minibatch = 9,
  food_place = 10,
  frozen_mutation = 11,
  initial_heading = 12,
  initial_food = 13,
  vacant_network = 14,
  vacant_genome = 15,
  hunt = 16,
  obstacle = 17,
  inherited_network = 18,
  recombination = 19,
};

/// The draws of one world for one purpose, one id (agent, food kind) and one step, counted by `index`.
struct RandomStream {
  uint64_t seed;
  Purpose purpose;
  uint32_t id;
  uint32_t step;

  HEDON_FN Random4 draw(uint32_t index) const {
    return philox({{index, static_cast<uint32_t>(purpose), id, step}}, static_cast<uint32_t>(seed),
                  static_cast<uint32_t>(seed >> 32));
  }
};

/// Uniform in [0, 1), a multiple of 2^-24.
HEDON_FN float to_uniform(uint32_t word) { return static_cast<float>(word >> 8) * 0x1p-24f; }
/// Uniform in [0, 1), a multiple of 2^-53: for probabilities per step, which can be far below 2^-24.
HEDON_FN double to_fine_uniform(uint32_t word0, uint32_t word1) {
  return static_cast<double>(((static_cast<uint64_t>(word0) << 32) | word1) >> 11) * 0x1p-53;
}
/// Uniform in (0, 1), an odd multiple of 2^-33: never 0 or 1, for logarithms and tangents.
HEDON_FN double to_open_uniform(uint32_t word) { return (static_cast<double>(word) + 0.5) * 0x1p-32; }
/// Uniform in {0, …, count - 1}, by multiplication; the bias is below count / 2^32.
HEDON_FN uint32_t to_index(uint32_t word, uint32_t count) {
  return static_cast<uint32_t>((static_cast<uint64_t>(word) * count) >> 32);
}

struct NormalPair {
  float first, second;
};

/// Two independent standard normals (Box and Muller 1958).
HEDON_FN NormalPair to_normal(uint32_t word0, uint32_t word1) {
  const double radius = sqrt(-2.0 * log_double(to_open_uniform(word0)));
  double sine, cosine;
  sincos_double(2.0 * PI * to_open_uniform(word1), &sine, &cosine);
  return {static_cast<float>(radius * cosine), static_cast<float>(radius * sine)};
}

/// Standard Cauchy: tan(π(u - 1/2)).
HEDON_FN float to_cauchy(uint32_t word) {
  double sine, cosine;
  sincos_double(PI * (to_open_uniform(word) - 0.5), &sine, &cosine);
  return static_cast<float>(sine / cosine);
}

/// Student's t with `df` degrees of freedom (Bailey 1994, the polar method).
HEDON_FN float to_student_t(double df, uint32_t word0, uint32_t word1) {
  const double radius = sqrt(df * (exp_double(-2.0 / df * log_double(to_open_uniform(word0))) - 1.0));
  double sine, cosine;
  sincos_double(2.0 * PI * to_open_uniform(word1), &sine, &cosine);
  return static_cast<float>(radius * cosine);
}

}  // namespace hedon
