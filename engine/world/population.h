/// The slot table: births take a slot, deaths free one.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "evolution/genome.h"
#include "world/food.h"
#include "world/mating.h"
#include "world/newborn.h"
#include "world/placement.h"
#include "world/world.h"

namespace hedon {

/// Lists the living agents by ascending slot. A team divides them in this order, so that each member's part of every
/// array is contiguous. In the order of ids, slots of two members would share most cache lines, which would then move
/// back and forth between the cores.
template <class Crew>
HEDON_FN void list_by_slot(const Crew& crew, World& world) {
  crew.select(
      0, world.shape->capacity, [&](int32_t slot) { return world.state.alive[slot] != 0; },
      [&](int32_t at, int32_t slot) { world.scratch.by_slot[at] = slot; });
}

/// Takes a free slot of a species; there must be one.
HEDON_FN int32_t take_free_slot(const World& world, int32_t species) {
  return world.state.free[world.shape->of[species].first_slot + --world.state.free_count[species]];
}

HEDON_FN void give_back_slot(const World& world, int32_t slot) {
  const int32_t species = world.shape->species_of(slot);
  world.state.free[world.shape->of[species].first_slot + world.state.free_count[species]++] = slot;
}

/// Adds an agent with the next id, a body at rest and no history, last in the living order. The caller gives it its
/// network and genome.
HEDON_FN int32_t spawn(World& world, int32_t species, Vec2 position, float angle, double energy, int64_t birth_step) {
  WorldState& state = world.state;
  WorldHead& head = world.head();
  const int32_t slot = take_free_slot(world, species);
  const int32_t id = head.next_agent_id++;
  if (head.next_agent_id == INT32_MAX) world.fail(Status::id_overflow, id, id);
  state.alive[slot] = 1;
  state.living[head.living_count++] = slot;
  state.life[slot] = Life{birth_step, -1, id, -1, 0, 0, energy, energy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const int32_t meals = world.shape->meals();
  for (int32_t m = 0; m < meals; ++m) state.eaten[int64_t{slot} * meals + m] = world.meal(slot)[m] = 0;
  state.touch[slot] = 0;
  if (state.touch_more.count > 0) state.touch_more[slot] = 0;
  if (world.shape->hunting) state.digestion[slot] = world.scratch.eaten[slot] = 0;
  if (state.species.count > 0) state.species[slot] = species;
  for (int64_t m = 0; m < world.shape->memory; ++m) state.memory[int64_t{slot} * world.shape->memory + m] = 0.0;
  for (int64_t i = 0; i < world.shape->last; ++i) state.last[int64_t{slot} * world.shape->last + i] = 0.0f;
  if (world.shape->counts_births) state.births[slot] = 0;
  for (int64_t a = 0; a < ACTIONS && state.external_action.count > 0; ++a)
    state.external_action[int64_t{slot} * ACTIONS + a] = 0.0f;
  if (world.shape->mating) state.ready_until[slot] = state.mate_id[slot] = -1;
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

/// Adds an agent without parents, with a new network and a newly drawn genome. In a new world, they are born at step 0.
HEDON_FN int32_t spawn_founder(World& world, int32_t species, Vec2 position, float angle, double energy,
                               int64_t birth_step = 0) {
  const int32_t slot = spawn(world, species, position, angle, energy, birth_step);
  const Species& own = world.shape->of[species];
  const SpeciesLayout& layout = own.layout;
  for (int32_t i = 1; i < own.stores(); ++i) world.held(slot, i) = store_of(own.config, i).initial;
  give_own_network(world, slot);
  const uint32_t id = static_cast<uint32_t>(world.state.life[slot].agent_id);
  init_genome(layout, RandomStream{world.seed, Purpose::initial_genome, id, 0}, world.genome(slot));
  express_genes(world, slot);
  world.counters(slot).energy_initial += energy;
  return slot;
}

/// The radius of an agent of a species with this genome.
HEDON_FN float radius_of_genome(const World& world, int32_t species, const float* genome) {
  const BodyTable& bodies = world.shape->bodies;
  return radius_by(world.shape->of[species], genome, bodies.smallest[species], bodies.largest[species]);
}

/// The radius that the founder of a species with this id will have.
HEDON_FN float founder_radius(const World& world, int32_t species, int32_t id) {
  const Species& common = world.shape->of[species];
  if (world.shape->bodies.own == 0) return common.config.body.radius;
  float genome[MAX_GENES];
  init_genome(common.layout, RandomStream{world.seed, Purpose::initial_genome, static_cast<uint32_t>(id), 0}, genome);
  return radius_of_genome(world, species, genome);
}

/// Makes the genome of the child with this id of `parent`, and of `mate` unless that is -1.
HEDON_FN void make_child_genome(const World& world, int32_t parent, int32_t mate, uint32_t id, float* genome) {
  const WorldHead& head = world.head();
  const float* from = world.genome(parent);
  if (mate >= 0) {
    recombine(world, id, parent, mate, genome);
    from = genome;
  }
  inherit(world.species(parent).layout, world.config->world.mutation_noise, world.seed, id,
          {static_cast<uint32_t>(head.births_before), static_cast<uint32_t>(head.births_in_window)}, from, genome);
}

/// The radius that the next child of these parents will have.
HEDON_FN float child_radius(const World& world, int32_t parent, int32_t mate) {
  if (world.shape->bodies.own == 0) return world.species(parent).config.body.radius;
  float genome[MAX_GENES];
  make_child_genome(world, parent, mate, static_cast<uint32_t>(world.head().next_agent_id), genome);
  return radius_of_genome(world, world.shape->species_of(parent), genome);
}

/// The heading of the child with this id, born in this step.
HEDON_FN float child_heading(const World& world, uint32_t id) {
  const bool shared = world.config->world.child_heading == WorldChildHeading::shared;
  const uint32_t step = shared ? static_cast<uint32_t>(world.head().step) : 0;
  const Random4 bits = RandomStream{world.seed, Purpose::child_heading, shared ? 0 : id, step}.draw(0);
  return wrap_angle(TWO_PI_F * to_uniform(bits.word[0]));
}

/// Takes a parent's contribution to a child of `parents` parents from each of its stores, and adds it to `given`.
HEDON_FN void give_child_shares(World& world, int32_t parent, int32_t parents, double* given) {
  const Species& species = world.species(parent);
  for (int32_t i = 0; i < species.stores(); ++i) {
    const double share = static_cast<double>(store_of(species.config, i).child_share) / parents;
    double& held = world.held(parent, i);
    const double part = share * held;
    held -= part;
    given[i] += part;
    if (i == ENERGY) world.counters(parent).energy_shared += part;
  }
  world.state.life[parent].children += 1;
  if (world.shape->counts_births) world.state.births[parent] += 1;
}

/// Adds a child of `parent`, and of `mate` unless that is -1, at `position`. It gets part of their stores, a mutated
/// genome, and a network, by default a new one that has learned nothing.
HEDON_FN void spawn_child(World& world, int32_t parent, int32_t mate, Vec2 position) {
  const WorldState& state = world.state;
  WorldHead& head = world.head();
  const Species& species = world.species(parent);
  double given[MAX_STORES] = {};
  const int32_t parents = mate < 0 ? 1 : 2;
  give_child_shares(world, parent, parents, given);
  if (mate >= 0) give_child_shares(world, mate, parents, given);
  const uint32_t id = static_cast<uint32_t>(head.next_agent_id);
  const int32_t slot =
      spawn(world, world.shape->species_of(parent), position, child_heading(world, id), given[ENERGY], head.step + 1);
  for (int32_t i = 1; i < species.stores(); ++i) world.held(slot, i) = given[i];
  Life& child = state.life[slot];
  child.parent_id = state.life[parent].agent_id;
  child.generation = state.life[parent].generation + 1;
  if (mate >= 0) {
    state.mate_id[slot] = state.life[mate].agent_id;
    const int32_t other = state.life[mate].generation + 1;
    child.generation = other > child.generation ? other : child.generation;
  }
  if (inherits_late(world)) {
    note_newborn(world, parent, child.agent_id);
    express_settings(world, slot);
    forget_updates(world,
                   slot);  // they are never used again, and a checkpoint does not contain the updates of free slots
  } else {
    give_child_network(world, parent, slot);
    make_child_genome(world, parent, mate, id, world.genome(slot));
    express_genes(world, slot);
  }
  head.births_in_window += 1;
  world.counters(parent).births += 1;
}

HEDON_FN Cause cause_of_death(const World& world, int32_t slot) {
  if (world.shape->hunting && world.scratch.eaten[slot] != 0) return Cause::eaten;
  return world.scratch.starved[slot] != 0 ? Cause::starved : Cause::age_energy;
}

/// Counts a death by its cause, in worlds with more than one cause.
HEDON_FN void count_cause(const World& world, int32_t slot) {
  if (!world.shape->causes) return;
  HuntCounters& counters = world.state.hunt_counters[world.shape->species_of(slot)];
  const Cause cause = cause_of_death(world, slot);
  counters.deaths_starved += cause == Cause::starved;
  counters.deaths_eaten += cause == Cause::eaten;
  if (cause == Cause::eaten) counters.energy_prey += world.state.life[slot].energy;
}

/// The row for the next death. Rows may never be read, so when all are taken, the oldest is replaced and counted as
/// lost.
HEDON_FN int64_t claim_death_row(WorldHead& head, int32_t rows) {
  return head.death_log_count < rows ? head.death_log_count++ : head.death_log_lost++ % rows;
}

/// Removes the agent in `slot` and saves its life for the records. The caller updates the living order.
HEDON_FN void kill(World& world, int32_t slot) {
  const WorldState& state = world.state;
  WorldHead& head = world.head();
  Life& life = state.life[slot];
  life.death_step = head.step + 1;
  state.alive[slot] = 0;
  mark_stale(state.physics);
  give_back_slot(world, slot);
  world.counters(slot).deaths += 1;
  world.counters(slot).energy_lost += life.energy;
  count_cause(world, slot);

  const int64_t row = claim_death_row(head, world.shape->death_log_rows);
  state.death_log[row] = life;
  state.death_log_species[row] = world.shape->species_of(slot);
  if (world.shape->mating) state.death_log_mate[row] = state.mate_id[slot];
  const int32_t meals = world.shape->meals(), genes = world.shape->genes;
  state.death_log_cause[row] = static_cast<int32_t>(cause_of_death(world, slot));
  for (int32_t m = 0; m < meals; ++m) state.death_log_eaten[row * meals + m] = state.eaten[int64_t{slot} * meals + m];
  for (int32_t g = 0; g < genes; ++g) state.death_log_genome[row * genes + g] = world.genome(slot)[g];
  for (int32_t i = 1; i < world.shape->stores; ++i)
    state.death_log_store[row * (world.shape->stores - 1) + i - 1] = world.held(slot, i);
}

/// Tries per founder or food of a new world; a half-full arena needs a few.
inline constexpr int32_t TRIES = 20000;

/// Looks for a free position for the founder with this number, anywhere in the arena.
HEDON_FN bool find_founder_position(const World& world, int32_t number, float radius, Vec2* position) {
  const ArenaConfig& arena = world.config->arena;
  const RandomStream random{world.seed, Purpose::initial_place, static_cast<uint32_t>(number), 0};
  for (int32_t i = 0; i < TRIES; ++i) {
    const Random4 bits = random.draw(static_cast<uint32_t>(i));
    *position = {arena.width * to_uniform(bits.word[0]), arena.height * to_uniform(bits.word[1])};
    if (can_place(world, *position, radius)) return true;
  }
  return false;
}

/// Puts the founders of all species into an empty world.
HEDON_FN void init_founders(World& world) {
  int32_t number = 0;
  for (int32_t s = 0; s < world.shape->species; ++s) {
    const SpeciesConfig& species = world.shape->of[s].config;
    for (int32_t i = 0; i < species.population.initial_count; ++i, ++number) {
      Vec2 position;
      if (!find_founder_position(world, number, founder_radius(world, s, number), &position))
        return world.fail(Status::initial_placement, number, number);
      const RandomStream random{world.seed, Purpose::initial_heading, static_cast<uint32_t>(number), 0};
      const float angle = wrap_angle(species.population.heading_range * to_uniform(random.draw(0).word[0]));
      spawn_founder(world, s, position, angle, species.energy.initial);
    }
  }
}

/// Places the living agents of a new world again, in their order, since their bodies have changed.
HEDON_FN void place_founders_again(World& world) {
  const WorldState& state = world.state;
  const BodyState& body = state.physics.bodies;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    state.alive[state.living[i]] = 0;
    remove(state.physics.body_grid, state.living[i]);
  }
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = state.living[i], id = state.life[slot].agent_id;
    Vec2 position;
    if (!find_founder_position(world, id, world.species(slot).body.radius, &position))
      return world.fail(Status::initial_placement, id, id);
    state.alive[slot] = 1;
    body.x[slot] = position.x;
    body.y[slot] = position.y;
    insert(state.physics.body_grid, slot, position.x, position.y);
  }
  mark_stale(state.physics);
}

/// Puts the founders and the first foods into an empty world.
HEDON_FN void init_population(World& world) {
  init_founders(world);
  if (world.fault().status != Status::ok) return;
  if (inherits_late(world)) fill_vacancies(world);
  open_window(world);
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    const FoodConfig& food = world.config->food[k];
    FoodStock& stock = world.state.food_stock[k];
    stock.number = food.initial_count;
    const RandomStream random{world.seed, Purpose::initial_food, static_cast<uint32_t>(k), 0};
    place_first_food(world, k, random, food.initial_count, TRIES);
    if (stock.present < food.initial_count) return world.fail(Status::initial_placement, -1, k);
  }
}

}  // namespace hedon
