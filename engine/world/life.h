/// Stores and age, and the births and deaths that depend on them.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "world/chance.h"
#include "world/channel.h"
#include "world/population.h"
#include "world/rule.h"
#include "world/store.h"
#include "world/world.h"

namespace hedon {

HEDON_FN bool is_eaten(const World& world, int32_t slot) {
  return world.shape->hunting && world.scratch.eaten[slot] != 0;
}

/// Decides whether an agent dies at the end of this step, from its draw and its chance.
HEDON_FN void decide_death(const World& world, int32_t slot, double chance) {
  world.scratch.dies[slot] =
      world.scratch.starved[slot] != 0 || is_eaten(world, slot) || world.scratch.death_draw[slot] < chance;
}

/// Decides whether an agent has a child at the end of this step, from its draw and its chance.
HEDON_FN void decide_birth(const World& world, int32_t slot, double draw, double chance) {
  world.scratch.breeds[slot] = world.scratch.starved[slot] == 0 && !is_eaten(world, slot) && draw < chance;
}

/// Credits one agent with its meals, and charges it for living and for its motors.
HEDON_FN void spend_energy(World& world, int32_t slot) {
  const WorldState& state = world.state;
  const StepScratch& scratch = world.scratch;
  Life& life = state.life[slot];
  const int32_t* meal = world.meal(slot);
  for (int32_t k = 0; k < world.shape->kinds; ++k) state.eaten[int64_t{slot} * world.shape->meals() + k] += meal[k];
  double damage = 0.0;
  if (world.shape->obstacles > 0) {
    damage = static_cast<double>(world.config->obstacle.damage) * scratch.touched[slot];
    scratch.energy_damage[slot] = damage;
  }
  scratch.starved[slot] = 0;
  const double force = applied_force(world, slot);
  for (int32_t i = 0; i < world.species(slot).stores(); ++i) settle_store(world, slot, i, force, damage);
  life.energy_gained += scratch.energy_eaten[slot];
  life.energy_spent += scratch.energy_basic[slot] + scratch.energy_action[slot] + damage;

  const BodyState& body = state.physics.bodies;
  const Vec2 moved{body.x[slot] - scratch.start_x[slot], body.y[slot] - scratch.start_y[slot]};
  life.distance += length(moved);
  life.force_left += scratch.force_left[slot];
  life.force_right += scratch.force_right[slot];
}

/// Writes one agent's reward for this step to its rollout, unless a rule computes it.
HEDON_FN void compute_reward(World& world, int32_t slot, int64_t t) {
  if (world.ruled(slot, RuleUse::reward)) return;
  const float r = own_reward(world, slot);
  world.state.reward[slot * int64_t{world.shape->rollout} + world.kept(slot, t)] = r;
  world.state.life[slot].reward += r;
}

/// An agent's draws for having a child, from the first two words, and for dying, from the others.
HEDON_FN Random4 fate_bits(const World& world, int32_t slot) {
  const RandomStream random{world.seed, Purpose::life_and_death, static_cast<uint32_t>(world.state.life[slot].agent_id),
                            static_cast<uint32_t>(world.head().step)};
  return random.draw(0);
}

/// Draws whether an agent has a child and whether it dies. If a rule computes its chances, this is decided later.
HEDON_FN void draw_births_and_deaths(World& world, int32_t slot) {
  const Random4 bits = fate_bits(world, slot);
  world.scratch.death_draw[slot] = to_fine_uniform(bits.word[2], bits.word[3]);
  if (!world.ruled(slot, RuleUse::birth))
    decide_birth(world, slot, to_fine_uniform(bits.word[0], bits.word[1]), birth_chance(world, slot));
  if (!world.ruled(slot, RuleUse::hazard)) decide_death(world, slot, death_chance(world, slot));
}

/// Decides which agents of a species die, or have a child, with the chances from its rule.
HEDON_FN void decide_by_rule(World& world, int32_t s, RuleUse use) {
  const int32_t count = ask_all(world, s, use);
  for (int32_t i = 0; i < count; ++i) {
    const int32_t slot = world.scratch.asked[i];
    const double chance = answered_chance(world, s, use, i);
    if (use == RuleUse::hazard) {
      decide_death(world, slot, chance);
    } else {
      const Random4 bits = fate_bits(world, slot);
      decide_birth(world, slot, to_fine_uniform(bits.word[0], bits.word[1]), chance);
    }
  }
}

/// Calls all rules: first for rewards, then for chances, which may depend on the memories that the former leave.
HEDON_FN void apply_rules(World& world) {
  for (int32_t s = 0; s < world.shape->species && world.shape->ruled; ++s) {
    const SpeciesLayout& layout = world.shape->of[s].layout;
    if (layout.has_rule(RuleUse::reward)) pay_by_rule(world, s);
    if (layout.has_rule(RuleUse::hazard)) decide_by_rule(world, s, RuleUse::hazard);
    if (layout.has_rule(RuleUse::birth)) decide_by_rule(world, s, RuleUse::birth);
  }
}

/// Decides again whether a parent dies, since it gave energy to a child.
HEDON_FN void decide_death_again(World& world, int32_t slot) {
  const bool ruled = world.ruled(slot, RuleUse::hazard);
  decide_death(world, slot, ruled ? ask_chance(world, slot, RuleUse::hazard) : death_chance(world, slot));
}

/// Adds an agent's meals of this step to the counts of its species.
HEDON_FN void count_meals(const World& world, int32_t slot) {
  const int32_t meals = world.shape->meals();
  int64_t* sum = &world.state.eaten_by[int64_t{world.shape->species_of(slot)} * meals];
  for (int32_t m = 0; m < meals; ++m) sum[m] += world.meal(slot)[m];
}

/// Counts what living agents did in this step, and adds the harm of obstacles to the ledger, in the living order.
HEDON_FN void count_steps(World& world) {
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = world.state.living[i];
    world.counters(slot).agent_steps += 1;
    if (world.state.eaten_by.count > 0) count_meals(world, slot);
    if (world.shape->obstacles == 0) continue;
    ObstacleCounters& harm = world.state.obstacle_counters[world.shape->species_of(slot)];
    harm.obstacles_touched += world.scratch.touched[slot];
    harm.energy_damage += world.scratch.energy_damage[slot];
  }
}

/// Adds the energy that living agents gained and spent in this step to the ledger: one thread for each sum, in the
/// living order. The threads differ only in their addresses, because a warp runs different branches in turn.
template <class Crew>
HEDON_FN void keep_ledger(const Crew& crew, World& world) {
  const StepScratch& scratch = world.scratch;
  crew.each(0, 5, [&](int32_t sum) {
    const auto pick = [sum](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
      return sum == 0 ? a : sum == 1 ? b : sum == 2 ? c : sum == 3 ? d : e;
    };
    const double* const energy = pick(scratch.energy_eaten.data, scratch.energy_basic.data, scratch.energy_action.data,
                                      scratch.energy_forgiven.data, scratch.energy_capped.data);
    double Counters::* const total = pick(&Counters::energy_eaten, &Counters::energy_basic, &Counters::energy_action,
                                          &Counters::energy_forgiven, &Counters::energy_capped);
    for (int32_t i = 0; i < world.head().living_count; ++i) {
      const int32_t slot = world.state.living[i];
      world.counters(slot).*total += energy[slot];
    }
  });
}

/// Looks for a free position for the child of `parent` around it.
/// radius   of the child
HEDON_FN bool find_child_position(const World& world, int32_t parent, float radius, Vec2* position) {
  const int32_t attempts = world.species(parent).config.birth.attempts;
  const float sd = world.species(parent).layout.distance_sd;
  const BodyState& body = world.state.physics.bodies;
  const RandomStream random{world.seed, Purpose::child_place, static_cast<uint32_t>(world.state.life[parent].agent_id),
                            static_cast<uint32_t>(world.head().step)};
  for (int32_t i = 0; i < attempts; ++i) {
    const Random4 bits = random.draw(static_cast<uint32_t>(i));
    const NormalPair normal = to_normal(bits.word[0], bits.word[1]);
    *position = {body.x[parent] + sd * normal.first, body.y[parent] + sd * normal.second};
    if (can_place(world, *position, radius)) return true;
  }
  return false;
}

/// Makes a child of `parent`, and of `mate` unless that is -1, if there are a free slot and a free place.
HEDON_FN void try_birth(World& world, int32_t parent, int32_t mate) {
  Counters& counters = world.counters(parent);
  Vec2 position;
  if (world.state.free_count[world.shape->species_of(parent)] == 0) {
    counters.births_failed_full += 1;
  } else if (!find_child_position(world, parent, child_radius(world, parent, mate), &position)) {
    counters.births_failed_space += 1;
  } else {
    spawn_child(world, parent, mate, position);
    // Decide again, since the parents gave energy to the child.
    decide_death_again(world, parent);
    if (mate < 0) return;
    decide_death_again(world, mate);
    end_waiting(world, parent, mate);
  }
}

/// Each agent that drew a birth has a child, in random order. In species with two parents, it has one together with a
/// waiting agent near it, or else starts to wait.
HEDON_FN void breed(World& world) {
  StepScratch& scratch = world.scratch;
  const WorldState& state = world.state;
  for (int32_t i = 0; i < world.head().living_count && world.shape->counts_births; ++i)
    state.births[state.living[i]] = 0;
  const uint32_t step = static_cast<uint32_t>(world.head().step);
  int32_t parents = 0;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = state.living[i];
    if (scratch.breeds[slot] == 0 || !may_breed(world, slot)) continue;
    const RandomStream random{world.seed, Purpose::parent_order, static_cast<uint32_t>(state.life[slot].agent_id),
                              step};
    const uint32_t key = random.draw(0).word[0];
    int32_t at = parents++;
    for (; at > 0 && scratch.parent_key[at - 1] > key; --at) {
      scratch.parent_key[at] = scratch.parent_key[at - 1];
      scratch.parent[at] = scratch.parent[at - 1];
    }
    scratch.parent_key[at] = key;
    scratch.parent[at] = slot;
  }
  for (int32_t p = 0; p < parents; ++p) {
    const int32_t parent = scratch.parent[p];
    const bool pairs = needs_mate(world, parent);
    const int32_t mate = pairs ? find_mate(world, parent) : -1;
    if (pairs) await_mate(world, parent);
    if (!pairs || mate >= 0) try_birth(world, parent, mate);
  }
}

/// Removes the agents with `dies` = 1. Newborns cannot die in the step of their birth.
HEDON_FN void apply_deaths(World& world, const Array<uint8_t>& dies) {
  const WorldState& state = world.state;
  WorldHead& head = world.head();
  int32_t kept = 0;
  for (int32_t i = 0; i < head.living_count; ++i) {
    const int32_t slot = state.living[i];
    if (dies[slot] != 0) {
      kill(world, slot);
    } else {
      state.living[kept++] = slot;
    }
  }
  head.living_count = kept;
  if (kept == 0 && head.extinct_step < 0) head.extinct_step = head.step + 1;
}

}  // namespace hedon
