/// One world: its config, its state, and the scratch of a step.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "config/config.h"
#include "kernel/kernel.h"
#include "physics/state.h"
#include "world/extent.h"
#include "world/state.h"

namespace hedon {

/// The circles of the living and of the foods, sorted by the cells of a grid, and the walls: all that rays may
/// hit. `gather_scene` computes it from the state.
struct RayScene {
  Array<float> x, y, radius, type;                  ///< of the circles: cell by cell, row by row of cells
  Array<int32_t> start;                             ///< first circle of each cell
  Array<int32_t> own;                               ///< index of the circle of the agent in each slot
  Array<int32_t> slot;                              ///< of the agent that a circle belongs to; -1 for a food
  Array<int32_t> cell;                              ///< of each circle, before sorting
  Array<float> wall_ax, wall_ay, wall_bx, wall_by;  ///< ends of the walls
  Array<int32_t> candidates;                        ///< see `RayCandidates`

  HEDON_ARRAYS(RayScene, (x, circles, one, scratch), (y, circles, one, scratch), (radius, circles, one, scratch),
               (type, circles, one, scratch), (start, cell_ends, one, scratch), (own, slots, one, scratch),
               (slot, query_circles, one, scratch), (cell, circles, one, scratch), (wall_ax, walls, one, derived),
               (wall_ay, walls, one, derived), (wall_bx, walls, one, derived), (wall_by, walls, one, derived),
               (candidates, candidates, one, scratch))
};

/// The result of an audit of one agent: `status` is ok if nothing is wrong.
struct Finding {
  Status status;
  int32_t other_id;
  double value;
};

/// The answer to a query at the start of the step.
struct Answer {
  int32_t count, kin;
  double distance;  ///< of the nearest [u]
  double bearing;   ///< of the nearest [rad]
};

/// Scratch memory of one step, by slot. Not valid between steps.
struct StepScratch {
  Array<int32_t> by_slot;                     ///< slots of the living, ascending: see `list_by_slot`
  Array<float> force_left, force_right;       ///< applied by the motors
  Array<float> force_x, force_y, torque;      ///< the same, on the body
  Array<float> heading_sine, heading_cosine;  ///< at the start of the step
  Array<float> start_angle, start_x, start_y;
  Array<int32_t> meal;       ///< foods, and agents of each species, eaten in this step
  Array<double> death_draw;  ///< uniform in [0, 1)
  Array<double> energy_eaten, energy_basic, energy_action, energy_forgiven, energy_capped;
  Array<uint8_t> starved, breeds, dies;  ///< 1 if it does
  Array<Finding> finding;                ///< of the audit at the end of a window
  Array<double> store_before;            ///< amount in each store before this step
  Array<float> smelled;                  ///< at the start of the step, by channel, then by nose
  Array<int32_t> touched;                ///< harmful obstacles that an agent touched
  Array<double> energy_damage;
  Array<int32_t> eater;                    ///< slot of the agent that gets the food, -1 for none
  Array<float> eater_distance;             ///< squared
  Array<uint8_t> eaten;                    ///< 1 if the agent was eaten in this step
  Array<int32_t> claim_eater, claim_prey;  ///< slots of both agents of a claim
  Array<int32_t> claim_of;       ///< index of the agent's own claim, -1 for none; not used if it may have several
  Array<float> claim_distance;   ///< squared
  Array<double> claim_gain;      ///< energy, if all claims are settled at once
  Array<double> record, answer;  ///< of the agents that a rule is called for, one after another
  Array<int32_t> asked;          ///< their slots
  Array<Answer> near;            ///< by slot: answers to its queries at the start of the step
  Array<int32_t> parent;
  Array<uint32_t> parent_key;

  HEDON_ARRAYS(StepScratch, (by_slot, slots, one, scratch), (force_left, slots, one, scratch),
               (force_right, slots, one, scratch), (force_x, slots, one, scratch), (force_y, slots, one, scratch),
               (torque, slots, one, scratch), (heading_sine, slots, one, scratch),
               (heading_cosine, slots, one, scratch), (start_angle, slots, one, scratch),
               (start_x, slots, one, scratch), (start_y, slots, one, scratch), (meal, slots, meals, scratch),
               (death_draw, slots, one, scratch), (energy_eaten, slots, one, scratch),
               (energy_basic, slots, one, scratch), (energy_action, slots, one, scratch),
               (energy_forgiven, slots, one, scratch), (energy_capped, slots, one, scratch),
               (starved, slots, one, scratch), (breeds, slots, one, scratch), (dies, slots, one, scratch),
               (finding, slots, one, scratch), (store_before, slots, stores, scratch),
               (smelled, slots, scents, scratch), (touched, obstacle_slots, one, scratch),
               (energy_damage, obstacle_slots, one, scratch), (eater, foods, one, scratch),
               (eater_distance, foods, one, scratch), (eaten, hunted_slots, one, scratch),
               (claim_eater, claims, one, scratch), (claim_prey, claims, one, scratch),
               (claim_of, hunted_slots, one, scratch), (claim_distance, claims, one, scratch),
               (claim_gain, claims, one, scratch), (record, ruled_slots, record, scratch),
               (answer, ruled_slots, one, scratch), (asked, ruled_slots, one, scratch), (near, slots, near, scratch),
               (parent, slots, one, scratch), (parent_key, slots, one, scratch))
};

/// Answers for `count` agents: reads and may change their records, one after another, and writes a number for each.
using Rule = void (*)(int64_t count, double* records, double* answers);

struct World {
  Rule rule[MAX_SPECIES][RULE_USES];  ///< of each species; null for none
  const Config* config;
  const WorldShape* shape;
  const Kernel* kernel;
  uint64_t seed;
  WorldState state;
  PhysicsScratch physics_scratch;
  StepScratch scratch;
  RayScene scene;

  HEDON_FN WorldHead& head() const { return state.head[0]; }
  HEDON_FN bool ruled(int32_t slot, RuleUse use) const { return shape->ruled && species(slot).layout.has_rule(use); }
  /// The settings of the agent in `slot` and the data derived from them, which belong to its species, or to itself if
  /// genes set some of them.
  HEDON_FN const Species& species(int32_t slot) const {
    return shape->own ? state.own[slot] : shape->of[shape->species_of(slot)];
  }
  HEDON_FN Counters& counters(int32_t slot) const { return state.counters[shape->species_of(slot)]; }
  HEDON_FN Fault& fault() const { return state.fault[0]; }
  /// The step at which the window of the current step began.
  HEDON_FN int64_t window_start() const { return head().step - head().step % shape->steps; }
  /// The step within its window.
  HEDON_FN int64_t window_step() const { return head().step % shape->steps; }
  HEDON_FN bool over() const { return head().extinct_step >= 0 || fault().status != Status::ok; }

  /// Keeps the first error; later ones are usually its consequences.
  HEDON_FN void fail(Status status, int32_t agent_id, double value, int32_t other_id = -1) const {
    if (fault().status == Status::ok) fault() = {status, agent_id, head().step, value, other_id, 0};
  }

  HEDON_FN float* params(int32_t slot) const { return &state.params[int64_t{slot} * shape->params]; }
  /// The network that the agent in `slot` was born with, in worlds that keep it.
  HEDON_FN float* initial_params(int32_t slot) const { return &state.initial_params[int64_t{slot} * shape->params]; }
  /// The network with which the agent in `slot` acts.
  HEDON_FN ActingNetwork network(int32_t slot) const {
    const bool rounded = species(slot).config.learning.acting_weights == LearningActingWeights::bfloat16;
    float* packed_weights = rounded ? &state.packed_weights[int64_t{slot} * shape->pairs] : nullptr;
    return {params(slot), &state.folded_bias[int64_t{slot} * HIDDEN], packed_weights};
  }
  HEDON_FN float* genome(int32_t slot) const { return &state.genome[int64_t{slot} * shape->genes]; }
  /// The amount in a store of the agent in `slot`.
  HEDON_FN double& held(int32_t slot, int32_t store) const {
    if (store == ENERGY) return state.life[slot].energy;
    return state.store[int64_t{slot} * (shape->stores - 1) + store - 1];
  }
  HEDON_FN double* held_before(int32_t slot) const { return &scratch.store_before[int64_t{slot} * shape->stores]; }
  HEDON_FN int32_t* meal(int32_t slot) const { return &scratch.meal[int64_t{slot} * shape->meals()]; }
  /// The row of a rollout for step `t` of the window. Without learning, only the present step is kept.
  HEDON_FN int64_t kept(int32_t slot, int64_t t) const { return species(slot).learns ? t : 0; }
  HEDON_FN PackedObservation& observation(int32_t slot, int64_t t) const {
    ObservationLine* line = &state.observation[(slot * (int64_t{shape->rollout} + 1) + t) * shape->lines];
    return *reinterpret_cast<PackedObservation*>(line);
  }
};

}  // namespace hedon
