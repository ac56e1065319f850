/// Observation and action of agents on the threads of a block: one tile of 16 threads for each agent.
#pragma once

#include "cuda/block.h"
#include "cuda/lanes.h"
#include "cuda/variant.h"
#include "kernel/cast_rays.h"
#include "kernel/cull_circles.h"
#include "kernel/network_forward.h"
#include "simulation/window.h"

namespace hedon {

/// The kernels of a tile under the names of `RayKernels`.
struct TileKernel {
  HEDON_INLINE void cull_circles(const RayTargets& targets, const RayFan& fan, int32_t first, int32_t last,
                                 RayCandidates& candidates) const {
    hedon::cull_circles(targets, fan, first, last, candidates);
  }
};

/// Removes the circles of types that a species does not see, on one thread; all threads get the counts.
HEDON_FN void drop_unseen_by_tile(const Block& block, const RayScene& scene, const Channels& sight,
                                  RayCandidates& candidates) {
  block.once_by_tile([&] { drop_unseen(scene, sight, candidates); });
  for (int32_t a = 0; a < RAY_ARCS; ++a) candidates.circles[a] = tile_read_count(candidates.circles[a], 0);
}

/// The same as `cast_agent_rays`.
HEDON_FN void cast_rays_by_tile(const Block& block, const World& world, int32_t slot, PackedObservation& out) {
  const Species& species = world.species(slot);
  const Vec2 forward = forward_of(world, slot);
  const RayTargets targets = ray_targets(world);
  const RayFan fan = make_fan(world, slot, forward);
  const Vec2 right = ray_direction(species, 0, forward);
  const Vec2 left = ray_direction(species, fan.rays - 1, forward);
  RayCandidates candidates = no_candidates(world, block.tile());
  find_circles(TileKernel{}, world, targets, fan, box_of(right, left, fan.start + fan.length, species.fan_convex),
               candidates);
  tile_barrier();
  if (!species.sight.in_order) drop_unseen_by_tile(block, world.scene, species.sight, candidates);
  cast_rays(targets, fan, candidates, out.ray, out.ray_type);
  tile_barrier();
  if (misreads_obstacles(world)) {
    misread_obstacles(world, species, fan, thread_lane(), TILE, out);
    tile_barrier();
  }
  if (species.sight.in_order) return;
  for (int32_t r = thread_lane(); r < fan.rays; r += TILE) {
    const bool meets = out.ray[r] > 0.0f;
    out.ray_type[r] = meets ? static_cast<uint8_t>(species.sight.of_type[out.ray_type[r]]) : uint8_t{0};
  }
  tile_barrier();
}

/// The same as `observe`.
HEDON_FN void observe_by_tile(const Block& block, const World& world, int32_t slot, PackedObservation& out) {
  cast_rays_by_tile(block, world, slot, out);
  block.once_by_tile([&] { sense_body(world, slot, out); });
}

/// The same as `forward_by`.
/// hidden   (2, 64) in shared memory
template <class Matrix>
HEDON_FN void forward_by_tile(const NetworkShape& shape, const ActingNetwork& network, const Matrix& weights,
                              const PackedObservation& observation, float* hidden, float* output) {
  const PackedObservation* one = &observation;
  const float* const bias = network.params + shape.b2();
  first_layer<1>(shape, weights.after(shape.w1() / HIDDEN), network.folded_bias, &one, hidden);
  tile_barrier();
  multiply<1, WIDTH, HIDDEN, 1>(
      hidden, weights.after(shape.w2() / HIDDEN), 1, HIDDEN,
      [&](int, int column) HEDON_INLINED { return load(bias + column); },
      [&](int, int column, Lanes total) HEDON_INLINED { store(hidden + HIDDEN + column, tanh_lanes(total)); });
  heads(shape, network.params, hidden + HIDDEN, output);
  tile_barrier();
}

/// Gives mean (2) and value of the agent in `slot` to all threads of the tile.
HEDON_FN void output_of(const Block& block, const World& world, int32_t slot, const PackedObservation& observation,
                        float* output) {
  float* const hidden = shared_memory() + block.tile() * SENSE_FLOATS;
  const NetworkShape& shape = world.species(slot).network;
  const ActingNetwork network = world.network(slot);
  if (network.packed_weights == nullptr) {
    forward_by_tile(shape, network, PlainRows{network.params}, observation, hidden, output);
  } else {
    forward_by_tile(shape, network, PackedRows{network.packed_weights}, observation, hidden, output);
  }
}

/// Begins to load the weights with which the agent in `slot` will act, on one thread.
HEDON_FN void fetch_weights(const World& world, int32_t slot) {
  const NetworkShape& shape = world.species(slot).network;
  const ActingNetwork network = world.network(slot);
  const bool rounded = network.packed_weights != nullptr;
  const int32_t floats = rounded ? shape.pairs() : shape.size();
  fetch_ahead(rounded ? network.packed_weights : network.params, floats * static_cast<int32_t>(sizeof(float)));
}

/// All agents observe and act. `step` takes this one, which fits a block, instead of the one in `world/act.h`.
HEDON_FN void sense_and_act(Block& block, World& world, int64_t t) {
  block.for_each_by_tile(world.head().living_count, [&](int32_t i) {
    const int32_t slot = world.scratch.by_slot[i];
    const Species& species = world.species(slot);
    const int64_t row = world.kept(slot, t);
    PackedObservation& seen = world.observation(slot, row);
    block.once_by_tile([&] {
      if constexpr (VARIANT.fetch) {
        if (species.has_network) fetch_weights(world, slot);
      }
      note_start(world, slot);
    });
    if (species.observes) observe_by_tile(block, world, slot, seen);
    float output[OUTPUTS];
    if (species.has_network) output_of(block, world, slot, seen, output);
    if (thread_lane() != 0) return;
    if (species.has_network)
      sample_action(world, slot, row, output);
    else
      act_without_network(world, slot, row);
    apply_motors(world, slot, row);
  });
}

}  // namespace hedon
