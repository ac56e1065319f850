/// One step of a world, in the order of "The order of a step" in docs/model.md.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "physics/step.h"
#include "world/act.h"
#include "world/food.h"
#include "world/hunt.h"
#include "world/life.h"
#include "world/obstacle.h"
#include "world/sensor.h"
#include "world/world.h"

namespace hedon {

/// The parts whose time is reported.
enum class Part : int32_t { sense_and_act, physics, life, learning, count };
inline constexpr const char* PART_NAMES[] = {"sense_and_act", "physics", "life", "learning"};

/// Adds to a fault of the physics its step and agent: the first agent whose forces were not finite.
HEDON_FN void name_fault(World& world) {
  Fault& fault = world.fault();
  fault.step = world.head().step;
  if (fault.status != Status::not_finite) return;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = world.state.living[i];
    const float sum = world.scratch.force_left[slot] + world.scratch.force_right[slot];
    if (sum - sum == 0.0f) continue;
    fault.agent_id = world.state.life[slot].agent_id;
    fault.value = sum;
    return;
  }
}

/// Finds bodies that were so fast that they passed through the outer walls.
template <class Crew>
HEDON_FN void check_inside(const Crew& crew, World& world) {
  const BodyState& body = world.state.physics.bodies;
  const ArenaConfig& arena = world.config->arena;
  const auto outside = [&](int32_t i) {
    const float x = body.x[world.state.living[i]], y = body.y[world.state.living[i]];
    return !(x >= 0.0f && x <= arena.width && y >= 0.0f && y <= arena.height);
  };
  if (!crew.any_of(world.head().living_count, outside)) return;
  crew.once([&] {
    int32_t i = 0;
    while (!outside(i)) ++i;
    const int32_t slot = world.state.living[i];
    const float x = body.x[slot], y = body.y[slot];
    world.fail(Status::outside_arena, world.state.life[slot].agent_id, x < 0.0f || x > arena.width ? x : y);
  });
}

/// Computes the data for the start of a step from the state.
template <class Crew>
HEDON_FN void prepare_step(const Crew& crew, World& world) {
  list_by_slot(crew, world);
  gather_scene(crew, world);
}

/// Advances a world by one step, which must be prepared. All members of the group call it; `t` is the step
/// within the window. `lap(part)` is called at the end of each part.
template <class Group, class Lap>
HEDON_FN void step(Group& group, World& world, int64_t t, Lap&& lap) {
  WorldHead& head = world.head();
  const WorldState& state = world.state;
  const StepScratch& scratch = world.scratch;

  sense_and_act(group, world, t);
  lap(Part::sense_and_act);

  TouchVisitor touch{&world};
  const BodyForce force{scratch.force_x, scratch.force_y, scratch.torque};
  if (!physics_step(group, world.config->physics, world.shape->bodies, state.physics, world.physics_scratch,
                    state.living, head.living_count, force, touch, world.fault())) {
    group.once([&] { name_fault(world); });
    return;
  }
  lap(Part::physics);

  group.together([&](const auto& crew) {
    check_inside(crew, world);
    eat(crew, world);
    if (world.shape->obstacles > 0) crew.once([&] { count_obstacle_contacts(world); });
  });
  if (world.fault().status != Status::ok) return;
  const auto reward_and_fates = [&](int32_t slot) {
    compute_reward(world, slot, t);
    keep_last(world, slot);
    draw_births_and_deaths(world, slot);
  };
  if (!world.shape->hunting) {
    group.for_each(head.living_count, [&](int32_t i) {
      spend_energy(world, scratch.by_slot[i]);
      reward_and_fates(scratch.by_slot[i]);
    });
  } else {
    // A predator gains from what its prey has left after this step's costs.
    group.for_each(head.living_count, [&](int32_t i) { spend_energy(world, scratch.by_slot[i]); });
    group.once([&] { hunt(world); });
    group.for_each(head.living_count, [&](int32_t i) { reward_and_fates(scratch.by_slot[i]); });
  }
  group.together([&](const auto& crew) {
    crew.once([&] {
      apply_rules(world);
      count_steps(world);
    });
    keep_ledger(crew, world);
    crew.once([&] {
      if (world.shape->hunting) apply_deaths(world, scratch.eaten);
      if (world.config->world.birth_order == WorldBirthOrder::before_deaths) breed(world);
      apply_deaths(world, scratch.dies);
      if (world.config->world.birth_order == WorldBirthOrder::after_deaths) breed(world);
      grow(world);
      head.step += 1;
      if (head.step > UINT32_MAX) world.fail(Status::id_overflow, -1, static_cast<double>(head.step));
    });
    prepare_step(crew, world);
  });
  lap(Part::life);
}

}  // namespace hedon
