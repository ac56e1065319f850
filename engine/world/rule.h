/// Rewards by a rule of the caller: a function that pays all agents of a species at once.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/device.h"
#include "evolution/reward.h"
#include "world/world.h"

namespace hedon {

/// Euclidean norm of the two forces that the agent in `slot` applied in this step.
HEDON_FN float applied_force(const World& world, int32_t slot) {
  const float left = world.scratch.force_left[slot], right = world.scratch.force_right[slot];
  return sqrtf(left * left + right * right);
}

/// What the agent in `slot` is paid by, as `RewardInputs` has it; `t` is the step within the window.
HEDON_FN RewardInputs reward_inputs(const World& world, int32_t slot, int64_t t) {
  const Species& species = world.species(slot);
  const PackedObservation& seen = world.observation(slot, world.kept(slot, t));
  const Life& life = world.state.life[slot];
  const double* now = world.inner(slot);
  const double* before = world.inner_before(slot);
  const bool inner = world.shape->inner;
  return {
      .eaten = world.meal(slot),
      .force = applied_force(world, slot),
      .max_force = species.max_force,
      .ray = seen.ray,
      .ray_type = seen.ray_type,
      .rays = species.config->sensor.ray_count,
      .smelled = &world.scratch.smelled[int64_t{slot} * world.shape->scents],
      .noses = species.config->sensor.noses,
      .before = {world.scratch.energy_before[slot], inner ? before[0] : 0.0, inner ? before[1] : 0.0},
      .now = {life.energy, inner ? now[0] : 0.0, inner ? now[1] : 0.0},
      .capacity = {species.config->energy.capacity, species.config->nutrient.capacity, species.config->toxin.threshold},
      .age = static_cast<double>(world.head().step + 1 - life.birth_step)};
}

/// Mean reading of all rays, 0 for those that met nothing.
HEDON_FN float nearness(const RewardInputs& inputs) {
  float sum = 0.0f;
  for (int32_t r = 0; r < inputs.rays; ++r) sum += inputs.ray[r] > 0.0f ? inputs.ray[r] - 1.0f : 0.0f;
  return sum / static_cast<float>(inputs.rays);
}

/// Fills the record of one agent: see `rule_columns` in `hedon.config.layout`.
HEDON_FN void fill_record(const World& world, int32_t slot, int64_t t, double* record) {
  const SpeciesConfig& config = *world.species(slot).config;
  const RewardInputs inputs = reward_inputs(world, slot, t);
  const Life& life = world.state.life[slot];
  const BodyState& body = world.state.physics.bodies;
  const Vec2 moved{body.x[slot] - world.scratch.start_x[slot], body.y[slot] - world.scratch.start_y[slot]};
  for (int32_t i = 0; i < config.reward.terms.count; ++i)
    *record++ = static_cast<double>(reward_input(config.reward, config.reward.terms[i], world.genome(slot), inputs));
  for (int32_t g = 0; g < config.genome.genes.count; ++g) *record++ = static_cast<double>(world.genome(slot)[g]);
  *record++ = inputs.age;
  *record++ = inputs.before[ENERGY];
  *record++ = life.energy;
  *record++ = static_cast<double>(length(moved));
  *record++ = static_cast<double>(nearness(inputs));
  *record++ = static_cast<double>(world.scratch.force_left[slot]);
  *record++ = static_cast<double>(world.scratch.force_right[slot]);
  *record++ = static_cast<double>(reward(config.reward, world.genome(slot), inputs));
  const double* memory = &world.state.memory[int64_t{slot} * world.shape->memory];
  for (int32_t m = 0; m < config.reward.memory; ++m) *record++ = memory[m];
}

/// Pays the agents of a species by its rule, in the order of their ids.
HEDON_FN void pay_by_rule(World& world, int32_t s, int64_t t) {
  const WorldState& state = world.state;
  const StepScratch& scratch = world.scratch;
  const Species& species = world.shape->of[s];
  const int32_t memory = species.config->reward.memory, width = species.record;
  int32_t count = 0;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = state.living[i];
    if (slot < species.first_slot || slot >= species.last_slot) continue;
    fill_record(world, slot, t, &scratch.record[int64_t{count} * width]);
    scratch.paid[count] = static_cast<double>(NAN);  // stays where the rule fails half-way
    scratch.paid_slot[count++] = slot;
  }
  world.rule[s](count, scratch.record.data, scratch.paid.data);
  for (int32_t i = 0; i < count; ++i) {
    const int32_t slot = scratch.paid_slot[i];
    const double paid = scratch.paid[i];
    const double* kept = &scratch.record[int64_t{i + 1} * width - memory];
    double sum = paid;
    for (int32_t m = 0; m < memory; ++m) sum += state.memory[int64_t{slot} * world.shape->memory + m] = kept[m];
    if (!(sum - sum == 0.0)) return world.fail(Status::rule_not_finite, state.life[slot].agent_id, sum);
    state.reward[slot * int64_t{world.shape->rollout} + world.kept(slot, t)] = static_cast<float>(paid);
    state.life[slot].reward += static_cast<double>(static_cast<float>(paid));
  }
}

/// Pays the agents of all species that have a rule.
HEDON_FN void pay_by_rules(World& world, int64_t t) {
  for (int32_t s = 0; s < world.shape->species && world.shape->ruled; ++s) {
    if (world.shape->of[s].config->reward.rule != 0) pay_by_rule(world, s, t);
  }
}

}  // namespace hedon
