/// Rules of the caller: functions that compute, for all agents of a species at once, their rewards or their chances of
/// dying or of having a child.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "world/chance.h"
#include "world/channel.h"
#include "world/world.h"

namespace hedon {

/// The value that the config would give without a rule.
HEDON_FN double own_answer(const World& world, int32_t slot, RuleUse use) {
  switch (use) {
    case RuleUse::reward:
      return static_cast<double>(own_reward(world, slot));
    case RuleUse::hazard:
      return death_chance(world, slot);
    case RuleUse::birth:
      return birth_chance(world, slot);
  }
  return 0.0;
}

/// Fills the record of one agent: see `rule_columns` in `hedon.config.layout`.
HEDON_FN void fill_record(const World& world, int32_t slot, RuleUse use, double* record) {
  const int32_t s = world.shape->species_of(slot);
  const Species& species = world.shape->of[s];
  const SpeciesConfig& config = species.config;
  const SpeciesLayout& layout = species.layout;
  const PackedObservation& seen = seen_by(world, slot);
  for (int32_t i = 0; i < layout.terms.count; ++i)
    *record++ = static_cast<double>(read_channel(world, slot, seen, layout.terms[i].channel));
  for (int32_t g = 0; g < layout.genes.count; ++g) *record++ = static_cast<double>(world.genome(slot)[g]);
  for (int32_t i = 0; i < layout.recorded.count; ++i) *record++ = channel_value(world, slot, seen, layout.recorded[i]);
  *record++ = own_answer(world, slot, use);
  const double* memory = &world.state.memory[int64_t{slot} * world.shape->memory];
  for (int32_t m = 0; m < config.reward.memory; ++m) *record++ = memory[m];
}

/// Calls the rule of a species for the first `count` agents of `scratch.asked`.
HEDON_FN void ask(World& world, int32_t s, RuleUse use, int32_t count) {
  const StepScratch& scratch = world.scratch;
  for (int32_t i = 0; i < count; ++i) {
    fill_record(world, scratch.asked[i], use, &scratch.record[int64_t{i} * world.shape->of[s].record]);
    scratch.answer[i] = static_cast<double>(NAN);  // remains if the rule fails partway
  }
  world.rule[s][static_cast<int32_t>(use)](count, scratch.record.data, scratch.answer.data);
}

/// Calls the rule of a species for all of its agents, in the order of their ids. Returns how many there are.
HEDON_FN int32_t ask_all(World& world, int32_t s, RuleUse use) {
  const Species& species = world.shape->of[s];
  int32_t count = 0;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = world.state.living[i];
    if (slot >= species.first_slot && slot < species.last_slot) world.scratch.asked[count++] = slot;
  }
  ask(world, s, use, count);
  return count;
}

/// Copies the memory that a rule has left for agent number `i`.
HEDON_FN const double* memory_after(const World& world, int32_t s, int32_t i) {
  const Species& species = world.shape->of[s];
  return &world.scratch.record[int64_t{i + 1} * species.record - species.config.reward.memory];
}

/// Raises a fault: the rule of a species gave the agent in `slot` an invalid value.
HEDON_FN void fail_rule(const World& world, int32_t s, RuleUse use, Status status, int32_t slot, double value) {
  world.fail(status, world.state.life[slot].agent_id, value, s * RULE_USES + static_cast<int32_t>(use));
}

/// Gives the agents of a species the rewards from its rule.
HEDON_FN void pay_by_rule(World& world, int32_t s) {
  const WorldState& state = world.state;
  const int32_t memory = world.shape->of[s].config.reward.memory;
  const int32_t count = ask_all(world, s, RuleUse::reward);
  for (int32_t i = 0; i < count; ++i) {
    const int32_t slot = world.scratch.asked[i];
    const double* kept = memory_after(world, s, i);
    for (int32_t m = 0; m < memory; ++m) {
      state.memory[int64_t{slot} * world.shape->memory + m] = kept[m];
      if (!is_finite(kept[m])) return fail_rule(world, s, RuleUse::reward, Status::rule_not_finite, slot, kept[m]);
    }
    const float paid =
        static_cast<float>(world.scratch.answer[i]);  // infinite if the answer exceeds the range of a float
    if (!is_finite(static_cast<double>(paid)))
      return fail_rule(world, s, RuleUse::reward, Status::rule_not_finite, slot, world.scratch.answer[i]);
    const int64_t row = slot * int64_t{world.shape->rollout} + world.kept(slot, world.window_step());
    state.reward[row] = paid;
    state.life[slot].reward += static_cast<double>(paid);
  }
}

/// The chance that a rule gave as its answer `i`. It must be a probability, and the rule may not have changed memories.
HEDON_FN double answered_chance(const World& world, int32_t s, RuleUse use, int32_t i) {
  const int32_t slot = world.scratch.asked[i];
  const double chance = world.scratch.answer[i];
  if (!(chance >= 0.0 && chance <= 1.0)) fail_rule(world, s, use, Status::rule_no_chance, slot, chance);
  const double* kept = memory_after(world, s, i);
  for (int32_t m = 0; m < world.shape->of[s].config.reward.memory; ++m) {
    if (kept[m] != world.state.memory[int64_t{slot} * world.shape->memory + m])
      fail_rule(world, s, use, Status::rule_wrote, slot, kept[m]);
  }
  return chance;
}

/// Calls the rule of its species for a chance of the agent in `slot` only.
HEDON_FN double ask_chance(World& world, int32_t slot, RuleUse use) {
  const int32_t s = world.shape->species_of(slot);
  world.scratch.asked[0] = slot;
  ask(world, s, use, 1);
  return answered_chance(world, s, use, 0);
}

}  // namespace hedon
