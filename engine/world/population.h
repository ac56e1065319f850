/// The slot table: births take a slot, deaths free one.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "evolution/genome.h"
#include "learning/init.h"
#include "world/food.h"
#include "world/placement.h"
#include "world/world.h"

namespace hedon {

/// Lists the living by ascending slot. A team divides them in this order, so that each member's part of every array is
/// contiguous. In the order of ids, slots of two members would share most cache lines, which would then move back and
/// forth between the cores.
HEDON_FN void list_by_slot(World& world) {
  int32_t count = 0;
  for (int32_t slot = 0; slot < world.shape->slots; ++slot) {
    if (world.state.alive[slot]) world.scratch.by_slot[count++] = slot;
  }
}

/// A body at rest with a new network, no history and the next id, last in the living order. The caller sets its genome.
HEDON_FN int32_t spawn(World& world, Vec2 place, float angle, double energy, int64_t birth_step) {
  WorldState& state = world.state;
  Clock& clock = world.clock();
  const int32_t slot = state.free[--clock.free_count];
  const int32_t id = clock.next_agent_id++;
  if (clock.next_agent_id == INT32_MAX) world.fail(Status::id_overflow, id, id);
  state.alive[slot] = 1;
  state.living[clock.living_count++] = slot;
  state.life[slot] = Life{birth_step, -1, id, -1, 0, 0, energy, energy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (int32_t k = 0; k < world.shape->kinds; ++k) state.eaten[int64_t{slot} * world.shape->kinds + k] = 0;
  state.touch[slot] = 0;
  world.scratch.dies[slot] = 0;

  BodyState& body = state.physics.bodies;
  body.x[slot] = place.x;
  body.y[slot] = place.y;
  body.angle[slot] = angle;
  body.velocity_x[slot] = 0.0f;
  body.velocity_y[slot] = 0.0f;
  body.angular_velocity[slot] = 0.0f;
  insert(state.physics.body_grid, slot, place.x, place.y);
  mark_stale(state.physics);

  const NetworkShape& network = world.shape->network;
  float* params = world.params(slot);
  init_network(network, RandomStream{world.seed, Purpose::network, static_cast<uint32_t>(id), 0}, params);
  world.kernel->derive(network, world.network(slot));
  const int64_t first = int64_t{slot} * network.size();
  for (int32_t p = 0; p < network.size(); ++p) state.first_moment[first + p] = state.second_moment[first + p] = 0.0f;
  state.updates[slot] = 0;
  return slot;
}

/// A child of `parent` at `place`: part of its energy, its genome with mutation, and nothing that it learned.
HEDON_FN void bear(World& world, int32_t parent, Vec2 place) {
  const WorldState& state = world.state;
  Clock& clock = world.clock();
  Life& parent_life = state.life[parent];
  const double share = static_cast<double>(world.config->energy.birth_share) * parent_life.energy;
  parent_life.energy -= share;
  parent_life.children += 1;
  const uint32_t id = static_cast<uint32_t>(clock.next_agent_id);
  const Random4 bits = RandomStream{world.seed, Purpose::child_heading, id, 0}.draw(0);
  const int32_t slot = spawn(world, place, wrap_angle(TWO_PI_F * to_uniform(bits.word[0])), share, clock.step + 1);
  Life& child = state.life[slot];
  child.parent_id = parent_life.agent_id;
  child.generation = parent_life.generation + 1;
  inherit(world.shape->genome, world.config->genome, world.seed, id, static_cast<uint32_t>(clock.births_in_window),
          world.genome(parent), world.genome(slot));
  clock.births_in_window += 1;
  world.counters().births += 1;
  world.counters().energy_shared += share;
}

/// Removes the agent in `slot` and keeps its life for the records. The caller updates the living order.
HEDON_FN void bury(World& world, int32_t slot) {
  const WorldState& state = world.state;
  Clock& clock = world.clock();
  Life& life = state.life[slot];
  if (clock.event_count >= world.shape->events) {
    world.fail(Status::event_overflow, life.agent_id, clock.event_count);
    return;
  }
  life.death_step = clock.step + 1;
  state.alive[slot] = 0;
  mark_stale(state.physics);
  state.free[clock.free_count++] = slot;
  world.counters().deaths += 1;
  world.counters().energy_lost += life.energy;

  const int64_t event = clock.event_count++;
  state.event[event] = life;
  const int32_t kinds = world.shape->kinds, genes = world.shape->genome.size();
  for (int32_t k = 0; k < kinds; ++k) state.event_eaten[event * kinds + k] = state.eaten[int64_t{slot} * kinds + k];
  for (int32_t g = 0; g < genes; ++g) state.event_genome[event * genes + g] = world.genome(slot)[g];
}

/// Puts the founders and the first foods into an empty world.
HEDON_FN void found(World& world) {
  constexpr int32_t TRIES = 20000;  ///< per founder or food; a half-full arena needs a few
  const WorldConfig& config = *world.config;
  for (int32_t i = 0; i < config.population.initial_count; ++i) {
    const RandomStream random{world.seed, Purpose::initial_place, static_cast<uint32_t>(i), 0};
    int32_t tries = 0;
    Vec2 place;
    do {
      const Random4 bits = random.draw(static_cast<uint32_t>(tries));
      place = {config.arena.width * to_uniform(bits.word[0]), config.arena.height * to_uniform(bits.word[1])};
    } while (!can_place(world, place, config.body.radius) && ++tries < TRIES);
    if (tries == TRIES) return world.fail(Status::initial_placement, i, i);
    const Random4 bits = RandomStream{world.seed, Purpose::initial_heading, static_cast<uint32_t>(i), 0}.draw(0);
    const int32_t slot = spawn(world, place, wrap_angle(TWO_PI_F * to_uniform(bits.word[0])), config.energy.initial, 0);
    init_genome(world.shape->genome, config.genome, world.seed, static_cast<uint32_t>(i), world.genome(slot));
    world.counters().energy_initial += config.energy.initial;
  }
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    FoodStock& stock = world.state.food_stock[k];
    stock.number = config.food[k].initial_count;
    place_missing_food(world, k, RandomStream{world.seed, Purpose::initial_food, static_cast<uint32_t>(k), 0}, TRIES);
    if (stock.present < config.food[k].initial_count) return world.fail(Status::initial_placement, -1, k);
  }
}

}  // namespace hedon
