/// A window: N steps, then learning, then an audit. All agents have the same windows.
#pragma once

#include <cstdint>

#include "learning/ppo.h"
#include "world/audit.h"
#include "world/expression.h"
#include "world/step.h"

namespace hedon {

/// Every agent that lived through the whole window learns from its rollout, if its species learns; all others wait for
/// the next window.
/// `scratch` holds `stride` floats for each member of the group.
template <class Group>
HEDON_FN void learn_window(Group& group, World& world, float* scratch, int64_t stride) {
  const WorldState& state = world.state;
  const WorldShape& shape = *world.shape;
  WorldHead& head = world.head();
  const int64_t window_start = head.step - shape.steps;

  int32_t learners = 0;
  for (int32_t i = 0; i < head.living_count; ++i) {
    if (state.life[state.living[i]].birth_step <= window_start) ++learners;
  }
  // The living are in the order of birth, so those that lived through the window come first.
  group.for_each_claimed(learners, [&](int32_t i) {
    const int32_t slot = state.living[i];
    if (!world.species(slot).learns) return;
    note_start(world, slot);
    PackedObservation& next = world.observation(slot, shape.steps);
    observe(world, slot, group.rank(), next);
    float output[16];
    const Species& species = world.species(slot);
    world.kernel->forward(species.network, world.network(slot), next, output);

    const int64_t row = slot * int64_t{shape.steps};
    const int64_t first = int64_t{slot} * shape.params;
    const Rollout rollout{&world.observation(slot, 0),
                          &state.action[row * ACTIONS],
                          &state.log_prob[row],
                          &state.value[row],
                          &state.reward[row],
                          output[ACTIONS],
                          shape.steps};
    const Learner learner{&state.params[first], &state.first_moment[first], &state.second_moment[first],
                          &state.updates[slot]};
    const RandomStream random{world.seed, Purpose::minibatch, static_cast<uint32_t>(state.life[slot].agent_id),
                              static_cast<uint32_t>(head.step)};
    learn(*world.kernel, species.network, own_learning(world, slot), rollout, random, scratch + group.rank() * stride,
          learner);
    world.kernel->pack_weights(species.network, world.network(slot));
  });
  group.once([&] {
    for (int32_t i = 0; i < learners; ++i)
      world.counters(state.living[i]).learners += world.species(state.living[i]).learns;
    if (inherits_late(world)) settle_newborns(world);
    open_window(world);
  });
}

/// Advances a world by `steps` steps, with learning at the end of each window; stops early if the world is over.
/// `pacer(group, count, step_once)` calls `step_once(members)` up to `count` times, with the whole group or a part of
/// it.
template <class Group, class Pacer, class Lap>
HEDON_FN void advance(Group& group, World& world, int64_t steps, float* scratch, int64_t stride, Pacer&& pacer,
                      Lap&& lap) {
  const int64_t window = world.shape->steps;
  group.once([&] { prepare_step(world); });
  while (steps > 0 && !world.over()) {
    const int64_t left = window - world.head().step % window;
    const int64_t stretch = left < steps ? left : steps;
    steps -= pacer(group, stretch, [&](auto& members) {
      step(members, world, world.head().step % window, lap);
      return !world.over();
    });
    if (world.head().step % window == 0 && !world.over()) {
      learn_window(group, world, scratch, stride);
      lap(Part::learning);
      audit(group, world);
      lap(Part::life);
    }
  }
}

}  // namespace hedon
