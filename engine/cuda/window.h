/// Windows of many worlds as three kernels: step all worlds, update all learners, close the windows.
///
/// Each kernel is a functor that the threads of a block call with the block's number. CUDA and the emulation run the
/// same kernels.
#pragma once

#include "cuda/learning.h"
#include "cuda/sense.h"
#include "simulation/device.h"
#include "simulation/window.h"

namespace hedon {

static_assert(BLOCK_THREADS % 32 == 0 && BLOCK_THREADS / TILE <= DEVICE_MEMBERS);

/// The value of the next observation of each learner, to which its last reward leads.
HEDON_FN void bootstrap_by_block(Block& block, World& world, float* bootstrap) {
  block.for_each_by_tile(count_taught(world), [&](int32_t i) {
    const int32_t slot = world.state.living[i];
    if (!world.species(slot).learns) return;
    PackedObservation& next = world.observation(slot, world.shape->steps);
    block.once_by_tile([&] { note_start(world, slot); });
    observe_by_tile(block, world, slot, next);
    float output[OUTPUTS];
    output_of(block, world, slot, next, output);
    if (thread_lane() == 0) bootstrap[i] = output[ACTIONS];
  });
}

/// Advances world b by up to `steps` steps, which do not go past the end of its window.
struct StepWorlds {
  static constexpr DevicePart PART = DevicePart::step;
  DeviceWorlds on;
  int32_t first;  ///< row of the first world in `on.bootstrap`
  int64_t steps;

  static constexpr int64_t FLOATS = STAGE_FIRST + stage_floats(VARIANT.staged);
  HEDON_FN int32_t blocks() const { return on.count; }

  HEDON_FN void operator()(int32_t b) const {
    Block block;
    World& world = on.worlds[b];
    if (world.over()) return;
    block.together([&](const auto& crew) { prepare_step(crew, world); });
    for (int64_t i = 0; i < steps && !world.over(); ++i)
      step(block, world, world.head().step % world.shape->steps, [](Part) {});
    if (world.over() || world.head().step % world.shape->steps != 0) return;
    bootstrap_by_block(block, world, on.bootstrap + int64_t{first + b} * world.shape->capacity);
  }
};

/// Updates the learners of all worlds; each of n blocks takes every n-th learner.
struct LearnWorlds {
  static constexpr DevicePart PART = DevicePart::learn;
  DeviceWorlds on;
  int32_t first;  ///< row of the first world in `on.bootstrap`

  HEDON_FN int32_t blocks() const { return on.learners_at_once; }

  HEDON_FN void operator()(int32_t b) const {
    const Block block;
    const int32_t capacity = on.worlds[0].shape->capacity;
    // The first learners of all worlds, then the second ones, and so on, so that blocks have nearly equal numbers.
    for (int32_t i = b; i < on.count * capacity; i += blocks()) {
      const World& world = on.worlds[i % on.count];
      const int32_t rank = i / on.count;
      if (world.over() || rank >= world.head().living_count) continue;
      const int32_t slot = world.state.living[rank];
      const Species& species = world.species(slot);
      if (!species.learns || world.state.life[slot].birth_step > world.head().step - world.shape->steps) continue;
      const float value = on.bootstrap[int64_t{first + i % on.count} * capacity + rank];
      learn_by_block(block, species.network, own_learning(world, slot), rollout_of(world, slot, value),
                     minibatch_stream(world, slot), on.scratch + b * on.scratch_stride, learner_of(world, slot),
                     world.network(slot));
      block.barrier();
    }
  }
};

/// Closes the window of world b, checks the world, and begins the next window.
struct CloseWindows {
  static constexpr DevicePart PART = DevicePart::close;
  DeviceWorlds on;

  static constexpr int64_t FLOATS = 0;
  HEDON_FN int32_t blocks() const { return on.count; }

  HEDON_FN void operator()(int32_t b) const {
    Block block;
    World& world = on.worlds[b];
    if (world.over()) return;
    block.barrier();  // all threads have seen that the world is not over, so it may end now
    block.once([&] { close_window(world, count_taught(world)); });
    audit(block, world, [](int32_t) {});
  }
};

/// Fills the table of functions that single threads call, whose addresses the host does not know.
struct FillKernel {
  Kernel* kernel;

  static constexpr int64_t FLOATS = 0;
  HEDON_FN int32_t blocks() const { return 1; }
  HEDON_FN void operator()(int32_t) const {
    if (thread_rank() == 0) kernel->network.pack_weights = pack_weights_alone;
  }
};

/// Floats of shared memory that the updates of these worlds need.
inline int64_t learning_floats(const DeviceWorlds& on) {
  int64_t most = 0;
  for (int32_t s = 0; s < on.species; ++s) {
    const int64_t floats = learning_layout(on.params[s]).total;
    most = floats > most ? floats : most;
  }
  return most;
}

/// Groups that worlds are divided into, so that one steps while another one learns: as many as leave no multiprocessor
/// more than one world of a group. A single one if kernels do not overlap.
inline int32_t group_count(const DeviceWorlds& on) {
  if (!VARIANT.overlap) return 1;
  const int32_t multiprocessors = on.learners_at_once / VARIANT.learners;
  const int32_t groups = (on.count + multiprocessors - 1) / multiprocessors;
  return groups < MAX_GROUPS ? groups : MAX_GROUPS;
}

/// Advances all worlds. `launch(g, kernel, floats)` runs a kernel of group g after the previous kernel of this group
/// and the previous one of the same part, so no two groups step, or learn, at the same time.
template <class Launch>
void advance_worlds(const DeviceWorlds& on, int64_t step, int64_t steps, Launch&& launch) {
  const int32_t groups = group_count(on);
  while (steps > 0) {
    const int64_t left = on.window - step % on.window;
    const int64_t stretch = left < steps ? left : steps;
    for (int32_t g = 0; g < groups; ++g) {
      const int32_t first = on.count * g / groups;
      DeviceWorlds group = on;
      group.worlds += first;
      group.count = on.count * (g + 1) / groups - first;
      launch(g, StepWorlds{group, first, stretch}, StepWorlds::FLOATS);
      if (stretch < left) continue;
      if (on.learning) launch(g, LearnWorlds{group, first}, learning_floats(on));
      launch(g, CloseWindows{group}, CloseWindows::FLOATS);
    }
    step += stretch;
    steps -= stretch;
  }
}

}  // namespace hedon
