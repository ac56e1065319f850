/// The table of hot kernels. One table per instruction set; one is chosen when a simulation is made.
///
/// The units that fill a table are compiled for their instruction set. So they define nothing that the linker could use
/// in other code: everything in them is in an anonymous namespace, and they include no standard containers.
#pragma once

#include <cstdint>

#include "learning/config.h"
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

/// Circles and segments that rays may hit. Arrays are aligned to 64 bytes and readable to the next multiple of 16.
struct RayTargets {
  const float* circle_x;  ///< [u]
  const float* circle_y;
  const float* circle_radius;
  const float* circle_type;  ///< small integers, as floats
  const float* segment_ax;   ///< ends [u]
  const float* segment_ay;
  const float* segment_bx;
  const float* segment_by;
  int32_t segments;
  int32_t first_obstacle;  ///< segments from here on are sides of obstacles, whose type is the next one
  float segment_type;      ///< of the others
};

/// HIDDEN rows of floats, one after another.
struct Rows {
  const float* first;
  int32_t width;
};

inline constexpr int RAY_ARCS = PACKED_RAYS / 16;

/// The sector of the plane that 16 neighboring rays can reach: directions of its edges, 0 if it is not convex.
struct Arc {
  float right_x, right_y, left_x, left_y;
};

/// The rays of one agent, from the right to the left.
struct RayFan {
  float x, y;                  ///< the agent's center [u]
  float forward_x, forward_y;  ///< its heading, a unit vector
  const float* ray_cosine;     ///< of each ray's angle to the heading; (32), entries past `rays` repeat the last
  const float* ray_sine;
  int32_t rays;
  float start;    ///< distance from the center at which rays start: the body's radius [u]
  float length;   ///< of a ray, from its start [u]
  int32_t self;   ///< index of the agent's own circle, which its rays ignore; -1 if it has none
  float edge;     ///< 1: a circle is hit if its far edge is past the start of the ray; -1: only if its near edge is
  float nearest;  ///< distance from the center at which segments begin to be hit: 0, or `start` [u]
  Arc arc[RAY_ARCS];
  Rows next;  ///< data that is read after the rays are cast: prefetched meanwhile, one row per circle

  HEDON_INLINE int32_t arcs() const { return (rays + 15) / 16; }
};

/// Indices of the circles that the rays of each arc may hit. Each list has room for all circles and 16 more.
struct RayCandidates {
  int32_t* circle[RAY_ARCS];
  int32_t circles[RAY_ARCS];
};

struct Kernel {
  const char* name;

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

  /// Appends those of the circles [first, last) that each arc may touch, in order. No ray can hit those left out.
  void (*cull_circles)(const RayTargets& targets, const RayFan& fan, int32_t first, int32_t last,
                       RayCandidates& candidates);

  /// Nearest hit of each ray among the candidates circles and all segments: `reading` = 2 - d / length (that is, the
  /// observed reading + 1) and `type`; both are 0 if nothing is hit. Both have PACKED_RAYS entries, 0 past the fan's
  /// rays; `reading` is aligned to 64 bytes. Of equal distances the first counts, circles before segments.
  void (*cast_rays)(const RayTargets& targets, const RayFan& fan, const RayCandidates& candidates, float* reading,
                    uint8_t* type);

  /// Multiply-adds in registers, to measure this processor's peak rate. Reads a factor (below 1) from `result` and
  /// writes there a number that depends on all of them. Returns the number of floating-point operations.
  int64_t (*multiply_adds)(int64_t rounds, float* result);

  /// Sum of `count` floats, a multiple of 64, aligned to 64 bytes: reads as fast as possible, to measure caches.
  float (*sum_floats)(const float* values, int64_t count);
};

/// The kernel of that name if this processor can run it, the best one for an empty name, null for an unknown one.
const Kernel* find_kernel(const char* name);

/// Names of the kernels that this processor can run, best first, null-terminated.
const char* const* kernel_names();

}  // namespace hedon
