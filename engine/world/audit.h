/// Checks of every world at the end of each window: a run with an invalid state stops with a named fault.
#pragma once

#include <cstdint>
#include <cstring>

#include "base/device.h"
#include "base/math.h"
#include "base/vec2.h"
#include "physics/grid.h"
#include "world/world.h"

namespace hedon {

/// Whether all of `count` numbers are finite, from the bits of their exponents, many at a time.
HEDON_FN bool all_finite(const float* values, int64_t count) {
  constexpr uint32_t EXPONENT = 0x7F800000u;
  uint32_t wild = 0;
  for (int64_t i = 0; i < count; ++i) {
    uint32_t bits;
    memcpy(&bits, &values[i], sizeof bits);
    wild |= (bits & EXPONENT) == EXPONENT;
  }
  return wild == 0;
}

/// Every slot is either used by one living agent or free, as its flag indicates.
HEDON_FN void audit_slots(const World& world) {
  const WorldHead& head = world.head();
  const WorldState& state = world.state;
  const int32_t capacity = world.shape->capacity;
  int32_t free_slots = 0;
  bool sane = head.living_count >= 0 && head.living_count <= capacity;
  for (int32_t s = 0; s < world.shape->species; ++s) {
    const int32_t count = state.free_count[s];
    sane = sane && count >= 0 && count <= world.shape->of[s].capacity();
    free_slots += count;
  }
  if (!sane || head.living_count + free_slots != capacity) {
    return world.fail(Status::slots_inconsistent, -1, head.living_count);
  }
  const Array<uint8_t>& seen = world.scratch.starved;
  for (int32_t slot = 0; slot < capacity; ++slot) seen[slot] = 0;
  const auto look = [&](int32_t slot, uint8_t alive) {
    if (slot < 0 || slot >= capacity || seen[slot] != 0 || state.alive[slot] != alive) {
      return world.fail(Status::slots_inconsistent, -1, slot);
    }
    seen[slot] = 1;
  };
  for (int32_t i = 0; i < head.living_count; ++i) look(state.living[i], 1);
  for (int32_t s = 0; s < world.shape->species; ++s) {
    for (int32_t i = 0; i < state.free_count[s]; ++i) look(state.free[world.shape->of[s].first_slot + i], 0);
  }
}

/// Ids ascend in the living order and none exceeds the newest; counts of births, deaths and foods agree.
HEDON_FN void audit_counts(const World& world) {
  const WorldHead& head = world.head();
  int32_t before = -1;
  for (int32_t i = 0; i < head.living_count; ++i) {
    const Life& life = world.state.life[world.state.living[i]];
    const bool good = life.agent_id > before && life.agent_id < head.next_agent_id && life.parent_id < life.agent_id &&
                      life.birth_step <= head.step && life.death_step == -1;
    if (!good) return world.fail(Status::ids_inconsistent, life.agent_id, before, life.parent_id);
    before = life.agent_id;
  }
  // Every id was assigned once, to a founder or to a child.
  int64_t births = 0, deaths = 0;
  for (int32_t s = 0; s < world.shape->species; ++s) {
    births += world.state.counters[s].births;
    deaths += world.state.counters[s].deaths;
  }
  if (head.next_agent_id - deaths != head.living_count || births > head.next_agent_id) {
    return world.fail(Status::counts_inconsistent, -1, static_cast<double>(deaths));
  }
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    const FoodStock& stock = world.state.food_stock[k];
    int32_t present = 0;
    for (int32_t f = world.shape->food_offset[k]; f < world.shape->food_offset[k + 1]; ++f)
      present += world.state.physics.circles.present[f];
    if (present != stock.present) return world.fail(Status::counts_inconsistent, -1, present);
    if (!is_finite(stock.number)) return world.fail(Status::not_finite, -1, stock.number);
  }
}

/// No list holds more than its capacity.
HEDON_FN void audit_capacity(const World& world) {
  const NeighborList& list = world.state.physics.neighbors;
  const int32_t bodies = list.head[0].bodies;
  if (bodies < 0 || bodies > world.shape->capacity) return world.fail(Status::neighbor_overflow, -1, bodies);
  for (const PairList* pairs : {&list.bodies, &list.circles, &list.walls}) {
    const int32_t count = pairs->start[bodies];
    if (count < 0 || count > pairs->first.count) return world.fail(Status::neighbor_overflow, -1, count);
  }
  const int32_t eaten = world.head().eaten_food_count;
  if (eaten < 0 || eaten > world.state.eaten_food.count) world.fail(Status::counts_inconsistent, -1, eaten);
  const WorldHead& head = world.head();
  const int32_t logged = head.death_log_count;
  if (logged < 0 || logged > world.shape->death_log_rows || head.death_log_lost < 0)
    world.fail(Status::counts_inconsistent, -1, logged);
}

/// For each species: energy of its agents = initial + eaten + hunted + forgiven − basic − action − damage − capped −
/// lost, up to rounding: a step of an agent rounds at most eight sums, each by at most 2^-53 of its largest possible
/// value.
HEDON_FN void audit_ledger(const World& world, int32_t s) {
  constexpr double ROUNDING = 8.0 * 0x1p-53;
  const Counters& c = world.state.counters[s];
  double held = 0.0;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = world.state.living[i];
    if (world.shape->species_of(slot) == s) held += world.state.life[slot].energy;
  }
  const double eaten = c.energy_eaten < 0.0 ? -c.energy_eaten : c.energy_eaten;
  const double hunted = world.shape->hunting ? world.state.hunt_counters[s].energy_hunted : 0.0;
  const double damage = world.shape->obstacles > 0 ? world.state.obstacle_counters[s].energy_damage : 0.0;
  const double moved = damage + c.energy_initial + eaten + hunted + c.energy_forgiven + c.energy_basic +
                       c.energy_action + c.energy_capped + c.energy_lost + c.energy_shared +
                       world.shape->most_energy[s];
  const double due = c.energy_initial + c.energy_eaten + hunted + c.energy_forgiven - c.energy_basic - c.energy_action -
                     c.energy_capped - c.energy_lost - damage;
  const double gap = held > due ? held - due : due - held;
  const double steps = static_cast<double>(c.agent_steps + c.births + world.head().next_agent_id);
  if (!(gap <= ROUNDING * steps * moved)) world.fail(Status::ledger_open, -1, held - due);
}

/// Id of the agent whose circle has this index in the scene; -1 for a food.
HEDON_FN int32_t agent_at(const World& world, int32_t index) {
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = world.state.living[i];
    if (world.scene.own[slot] == index) return world.state.life[slot].agent_id;
  }
  return -1;
}

/// Whether a circle of the scene is a food eaten in this step, which is still seen but no longer there.
HEDON_FN bool was_eaten(const World& world, int32_t index) {
  const RayScene& scene = world.scene;
  for (int32_t e = 0; e < world.head().eaten_food_count; ++e) {
    const EatenFood& food = world.state.eaten_food[e];
    const int32_t type = world.shape->food_type(food.kind);
    if (scene.x[index] == food.x && scene.y[index] == food.y && static_cast<int32_t>(scene.type[index]) == type)
      return true;
  }
  return false;
}

/// How far two discs may overlap: the radius of a body. Overlaps after contacts are much smaller: motors close a gap by
/// at most about 0.3 u per substep, and the corrections of the next substep remove a third of that. With more overlap a
/// contact is ill-defined, since a body's center is inside the other object, and the two may pass through each other;
/// it means that a pair was missed. The solver jacobi leaves overlaps of 1 to 10 u in crowds, and its contacts are
/// well-defined up to the center. With it, the distance of centers must be at least a quarter of the distance at which
/// the two just touch.
HEDON_FN Finding audit_overlap(const World& world, int32_t slot) {
  const RayScene& scene = world.scene;
  const RayGrid& grid = world.shape->scene;
  const float radius = world.species(slot).body.radius;
  const int32_t own = scene.own[slot];
  const float x = scene.x[own], y = scene.y[own];
  const bool deep = world.config->physics.solver == PhysicsSolver::jacobi;
  const float largest = world.shape->bodies.max_radius();
  const float reach = largest > world.config->world.food_radius ? largest : world.config->world.food_radius;
  const int32_t first_column = cell_along(x - reach, grid.inverse_cell, grid.columns);
  const int32_t last_column = cell_along(x + reach, grid.inverse_cell, grid.columns);
  const int32_t last_row = cell_along(y + reach, grid.inverse_cell, grid.rows);
  // Check everything nearby, not only listed pairs, since the neighbor list itself may be wrong.
  for (int32_t row = cell_along(y - reach, grid.inverse_cell, grid.rows); row <= last_row; ++row) {
    const int32_t* start = scene.start.data + int64_t{row} * grid.columns;
    for (int32_t at = start[first_column]; at < start[last_column + 1]; ++at) {
      const Vec2 apart{scene.x[at] - x, scene.y[at] - y};
      const float limit = deep ? 0.25f * (radius + scene.radius[at]) : scene.radius[at];
      if (at == own || world.species(slot).touch.of_type[static_cast<int32_t>(scene.type[at])] < 0 ||
          !(squared_length(apart) < limit * limit) || was_eaten(world, at))
        continue;
      return {Status::overlap_too_deep, agent_at(world, at), radius + scene.radius[at] - length(apart)};
    }
  }
  return {Status::ok, -1, 0.0};
}

/// Checks the agent in `slot`: its numbers are finite, and its center is inside the arena but in no other object.
HEDON_FN Finding audit_agent(const World& world, int32_t slot) {
  const WorldState& state = world.state;
  const BodyState& body = state.physics.bodies;
  const float numbers[] = {body.x[slot],          body.y[slot],          body.angle[slot],
                           body.velocity_x[slot], body.velocity_y[slot], body.angular_velocity[slot]};
  for (const float number : numbers) {
    if (!is_finite(number)) return {Status::not_finite, -1, number};
  }
  const Species& species = world.species(slot);
  const int64_t size = species.network.size(), first = int64_t{slot} * world.shape->params;
  const bool network_finite = (!species.has_network || all_finite(world.params(slot), size)) &&
                              (!species.learns || (all_finite(&state.first_moment[first], size) &&
                                                   all_finite(&state.second_moment[first], size)));
  if (!network_finite || !all_finite(world.genome(slot), species.layout.genes.count))
    return {Status::not_finite, -1, species.learns ? static_cast<double>(state.updates[slot]) : 0.0};
  const double energy = state.life[slot].energy;
  if (!is_finite(energy)) return {Status::not_finite, -1, energy};

  const Array<Segment>& walls = state.physics.walls;
  for (int32_t w = 0; w < world.shape->outer_walls; ++w) {
    // The outer walls run clockwise, so the inside is to their right.
    const Vec2 along = walls[w].b - walls[w].a;
    const float inside = cross(Vec2{body.x[slot], body.y[slot]} - walls[w].a, along);
    if (inside < 0.0f) return {Status::outside_arena, -1, inside / length(along)};
  }
  return audit_overlap(world, slot);
}

/// Checks a world. All members of the group call it; the first problem, in canonical order, becomes the fault.
/// ahead(slot) is called a little before the agent in `slot` is checked.
template <class Group, class Ahead>
HEDON_FN void audit(Group& group, World& world, Ahead&& ahead) {
  group.once([&] {
    audit_slots(world);
    audit_capacity(world);
  });
  if (world.fault().status != Status::ok) return;
  const int32_t living = world.head().living_count;
  group.for_each(living, [&](int32_t i) {
    if (i + AHEAD < living) ahead(world.state.living[i + AHEAD]);
    world.scratch.finding[i] = audit_agent(world, world.state.living[i]);
  });
  group.once([&] {
    for (int32_t i = 0; i < living; ++i) {
      const Finding& found = world.scratch.finding[i];
      if (found.status == Status::ok) continue;
      world.fail(found.status, world.state.life[world.state.living[i]].agent_id, found.value, found.other_id);
    }
    audit_counts(world);
    for (int32_t s = 0; s < world.shape->species; ++s) audit_ledger(world, s);
  });
}

}  // namespace hedon
