/// The slot table: births take a slot, deaths free one.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "evolution/genome.h"
#include "world/food.h"
#include "world/newborn.h"
#include "world/placement.h"
#include "world/world.h"

namespace hedon {

/// Lists the living by ascending slot. A team divides them in this order, so that each member's part of every array is
/// contiguous. In the order of ids, slots of two members would share most cache lines, which would then move back and
/// forth between the cores.
HEDON_FN void list_by_slot(World& world) {
  int32_t count = 0;
  for (int32_t slot = 0; slot < world.shape->capacity; ++slot) {
    if (world.state.alive[slot]) world.scratch.by_slot[count++] = slot;
  }
}

/// A body at rest with no history and the next id, last in the living order. The caller gives it network and genome.
HEDON_FN int32_t spawn(World& world, Vec2 position, float angle, double energy, int64_t birth_step) {
  WorldState& state = world.state;
  WorldHead& head = world.head();
  const int32_t slot = state.free[--head.free_count];
  const int32_t id = head.next_agent_id++;
  if (head.next_agent_id == INT32_MAX) world.fail(Status::id_overflow, id, id);
  state.alive[slot] = 1;
  state.living[head.living_count++] = slot;
  state.life[slot] = Life{birth_step, -1, id, -1, 0, 0, energy, energy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (int32_t k = 0; k < world.shape->kinds; ++k) state.eaten[int64_t{slot} * world.shape->kinds + k] = 0;
  state.touch[slot] = 0;
  world.scratch.dies[slot] = 0;

  BodyState& body = state.physics.bodies;
  body.x[slot] = position.x;
  body.y[slot] = position.y;
  body.angle[slot] = angle;
  body.velocity_x[slot] = 0.0f;
  body.velocity_y[slot] = 0.0f;
  body.angular_velocity[slot] = 0.0f;
  insert(state.physics.body_grid, slot, position.x, position.y);
  mark_stale(state.physics);
  return slot;
}

/// The first agents: each with a new network and a genome of its own.
HEDON_FN int32_t spawn_founder(World& world, Vec2 position, float angle, double energy) {
  const int32_t slot = spawn(world, position, angle, energy, 0);
  give_own_network(world, slot);
  const uint32_t id = static_cast<uint32_t>(world.state.life[slot].agent_id);
  init_genome(world.shape->genome, world.config->genome, RandomStream{world.seed, Purpose::initial_genome, id, 0},
              world.genome(slot));
  world.counters().energy_initial += energy;
  return slot;
}

/// The heading of a child with this id that is born in this step.
HEDON_FN float child_heading(const World& world, uint32_t id) {
  const bool shared = world.config->birth.heading == ChildHeading::shared;
  const uint32_t step = shared ? static_cast<uint32_t>(world.head().step) : 0;
  const Random4 bits = RandomStream{world.seed, Purpose::child_heading, shared ? 0 : id, step}.draw(0);
  return wrap_angle(TWO_PI_F * to_uniform(bits.word[0]));
}

/// A child of `parent` at `position`: part of its energy, its genome with mutation, and nothing that it learned.
HEDON_FN void spawn_child(World& world, int32_t parent, Vec2 position) {
  const WorldState& state = world.state;
  WorldHead& head = world.head();
  Life& parent_life = state.life[parent];
  const double share = static_cast<double>(world.config->energy.birth_share) * parent_life.energy;
  parent_life.energy -= share;
  parent_life.children += 1;
  const uint32_t id = static_cast<uint32_t>(head.next_agent_id);
  const int32_t slot = spawn(world, position, child_heading(world, id), share, head.step + 1);
  Life& child = state.life[slot];
  child.parent_id = parent_life.agent_id;
  child.generation = parent_life.generation + 1;
  if (inherits_late(world)) {
    note_newborn(world, parent, child.agent_id);
  } else {
    give_own_network(world, slot);
    inherit(world.shape->genome, world.config->genome, world.seed, id,
            {static_cast<uint32_t>(head.births_before), static_cast<uint32_t>(head.births_in_window)},
            world.genome(parent), world.genome(slot));
  }
  head.births_in_window += 1;
  world.counters().births += 1;
  world.counters().energy_shared += share;
}

/// Removes the agent in `slot` and keeps its life for the records. The caller updates the living order.
HEDON_FN void kill(World& world, int32_t slot) {
  const WorldState& state = world.state;
  WorldHead& head = world.head();
  Life& life = state.life[slot];
  if (head.event_count >= world.shape->events) {
    world.fail(Status::event_overflow, life.agent_id, head.event_count);
    return;
  }
  life.death_step = head.step + 1;
  state.alive[slot] = 0;
  mark_stale(state.physics);
  state.free[head.free_count++] = slot;
  world.counters().deaths += 1;
  world.counters().energy_lost += life.energy;

  const int64_t event = head.event_count++;
  state.event[event] = life;
  const int32_t kinds = world.shape->kinds, genes = world.shape->genome.size();
  for (int32_t k = 0; k < kinds; ++k) state.event_eaten[event * kinds + k] = state.eaten[int64_t{slot} * kinds + k];
  for (int32_t g = 0; g < genes; ++g) state.event_genome[event * genes + g] = world.genome(slot)[g];
}

/// Puts the founders and the first foods into an empty world.
HEDON_FN void init_population(World& world) {
  constexpr int32_t TRIES = 20000;  ///< per founder or food; a half-full arena needs a few
  const WorldConfig& config = *world.config;
  for (int32_t i = 0; i < config.population.initial_count; ++i) {
    const RandomStream random{world.seed, Purpose::initial_place, static_cast<uint32_t>(i), 0};
    int32_t tries = 0;
    Vec2 position;
    do {
      const Random4 bits = random.draw(static_cast<uint32_t>(tries));
      position = {config.arena.width * to_uniform(bits.word[0]), config.arena.height * to_uniform(bits.word[1])};
    } while (!can_place(world, position, config.body.radius) && ++tries < TRIES);
    if (tries == TRIES) return world.fail(Status::initial_placement, i, i);
    const Random4 bits = RandomStream{world.seed, Purpose::initial_heading, static_cast<uint32_t>(i), 0}.draw(0);
    const float angle = wrap_angle(config.population.heading_range * to_uniform(bits.word[0]));
    spawn_founder(world, position, angle, config.energy.initial);
  }
  if (inherits_late(world)) fill_vacancies(world);
  open_window(world);
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    FoodStock& stock = world.state.food_stock[k];
    stock.number = config.food[k].initial_count;
    place_missing_food(world, k, RandomStream{world.seed, Purpose::initial_food, static_cast<uint32_t>(k), 0}, TRIES);
    if (stock.present < config.food[k].initial_count) return world.fail(Status::initial_placement, -1, k);
  }
}

}  // namespace hedon
