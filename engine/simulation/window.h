/// A window: N steps, then learning, then an audit. All agents have the same windows.
#pragma once

#include <cstdint>

#include "simulation/learn.h"
#include "world/audit.h"
#include "world/expression.h"
#include "world/step.h"

namespace hedon {

/// How many agents lived through the window that ends now. The living are in the order of birth, so these come first.
HEDON_FN int32_t count_taught(const World& world) {
  const int64_t window_start = world.head().step - world.shape->steps;
  int32_t taught = 0;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    if (world.state.life[world.state.living[i]].birth_step <= window_start) ++taught;
  }
  return taught;
}

/// The whole window of the agent in `slot`.
/// bootstrap   value of its next observation
HEDON_FN Rollout rollout_of(const World& world, int32_t slot, float bootstrap) {
  const WorldState& state = world.state;
  const int64_t row = slot * int64_t{world.shape->steps};
  return {&world.observation(slot, 0), &state.action[row * ACTIONS], &state.log_prob[row],
          &state.value[row],           &state.reward[row],           bootstrap,
          world.shape->steps};
}

HEDON_FN Learner learner_of(const World& world, int32_t slot) {
  const WorldState& state = world.state;
  const int64_t first = int64_t{slot} * world.shape->params;
  return {&state.params[first], &state.first_moment[first], &state.second_moment[first], &state.updates[slot]};
}

/// Decides the order of the minibatches of the agent in `slot` in the window that ends now.
HEDON_FN RandomStream minibatch_stream(const World& world, int32_t slot) {
  return {world.seed, Purpose::minibatch, static_cast<uint32_t>(world.state.life[slot].agent_id),
          static_cast<uint32_t>(world.head().step)};
}

/// Completes a window after the first `taught` living agents have learned: counts, waiting genomes, the next window.
HEDON_FN void close_window(World& world, int32_t taught) {
  for (int32_t i = 0; i < taught; ++i) {
    const int32_t slot = world.state.living[i];
    world.counters(slot).learners += world.species(slot).learns;
  }
  if (inherits_late(world)) apply_late_inheritance(world);
  open_window(world);
}

/// Every agent that lived through the whole window learns from its rollout, if its species learns; all others wait for
/// the next window.
/// `scratch` holds `stride` floats for each member of the group. ahead(slot) is called shortly before the agent in
/// `slot` learns.
template <class Group, class Ahead>
HEDON_FN void learn_window(Group& group, World& world, float* scratch, int64_t stride, Ahead&& ahead) {
  const int32_t taught = count_taught(world);
  group.for_each_claimed(taught, [&](int32_t i) {
    const int32_t slot = world.state.living[i];
    if (i + AHEAD < taught) ahead(world.state.living[i + AHEAD]);
    const Species& species = world.species(slot);
    if (!species.learns) return;
    note_start(world, slot);
    PackedObservation& next = world.observation(slot, world.shape->steps);
    observe(world, slot, group.rank(), next);
    float output[16];
    world.kernel->network.forward(species.network, world.network(slot), next, output);
    learn(world.kernel->network, species.network, own_learning(world, slot), rollout_of(world, slot, output[ACTIONS]),
          minibatch_stream(world, slot), scratch + group.rank() * stride, learner_of(world, slot));
    world.kernel->network.pack_weights(species.network, world.network(slot));
  });
  group.once([&] { close_window(world, taught); });
}

/// Advances a world by `steps` steps, with learning at the end of each window; stops early if the world is over.
/// `pacer(group, count, step_once)` calls `step_once(members)` up to `count` times, with the whole group or a part of
/// it.
/// `cold` has `rollout(slot)` and `moments(slot)`, which are called shortly before an agent's rollout and moments are
/// read.
template <class Group, class Pacer, class Lap, class Cold>
HEDON_FN void advance(Group& group, World& world, int64_t steps, float* scratch, int64_t stride, Pacer&& pacer,
                      Lap&& lap, const Cold& cold) {
  const int64_t window = world.shape->steps;
  group.together([&](const auto& crew) { prepare_step(crew, world); });
  while (steps > 0 && !world.over()) {
    const int64_t left = window - world.head().step % window;
    const int64_t stretch = left < steps ? left : steps;
    steps -= pacer(group, stretch, [&](auto& members) {
      step(members, world, world.head().step % window, lap);
      return !world.over();
    });
    if (world.head().step % window == 0 && !world.over()) {
      learn_window(group, world, scratch, stride, [&](int32_t slot) {
        cold.rollout(slot);
        cold.moments(slot);
      });
      lap(Part::learning);
      audit(group, world, [&](int32_t slot) { cold.moments(slot); });
      lap(Part::life);
    }
  }
}

}  // namespace hedon
