/// One world: its config, its state, and the scratch of a step.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "kernel/kernel.h"
#include "physics/state.h"
#include "world/config.h"
#include "world/shape.h"
#include "world/state.h"

namespace hedon {

/// The circles of the living and of the foods, sorted by the cells of a grid, and the walls: all that rays may
/// hit. `gather_scene` computes it from the state.
struct RayScene {
  Array<float> x, y, radius, type;                  ///< (circles) of the circles: cell by cell, row by row of cells
  Array<int32_t> start;                             ///< (cells + 1) first circle of each cell
  Array<int32_t> own;                               ///< (slots) index of the circle of the agent in each slot
  Array<int32_t> cell;                              ///< (circles) of each circle, before sorting
  Array<float> wall_ax, wall_ay, wall_bx, wall_by;  ///< (walls)
  Array<int32_t> candidates;  ///< (members, RAY_ARCS, circles + 16) for each member of the team: see `RayCandidates`

  HEDON_FIELDS(RayScene, x, y, radius, type, start, own, cell, wall_ax, wall_ay, wall_bx, wall_by, candidates)
};

/// The result of an audit of one agent: `status` is ok if nothing is wrong.
struct Finding {
  Status status;
  int32_t other_id;
  double value;
};

/// Scratch memory of one step, by slot. Not valid between steps.
struct StepScratch {
  Array<int32_t> by_slot;                     ///< (slots) slots of the living, ascending: see `list_by_slot`
  Array<float> force_left, force_right;       ///< applied by the motors
  Array<float> force_x, force_y, torque;      ///< the same, on the body
  Array<float> heading_sine, heading_cosine;  ///< at the start of the step
  Array<float> start_angle, start_x, start_y;
  Array<int32_t> meal;       ///< (slots, kinds) foods eaten in this step
  Array<double> death_draw;  ///< uniform in [0, 1)
  Array<double> energy_eaten, energy_basic, energy_action, energy_forgiven, energy_capped;
  Array<uint8_t> starved, breeds, dies;  ///< 1 where it does
  Array<Finding> finding;                ///< of the audit at the end of a window
  Array<int32_t> eater;                  ///< (foods) slot of the agent that gets the food, -1 for none
  Array<float> eater_distance;           ///< (foods) squared
  Array<int32_t> parent;                 ///< (slots)
  Array<uint32_t> parent_key;            ///< (slots)

  HEDON_FIELDS(StepScratch, by_slot, force_left, force_right, force_x, force_y, torque, heading_sine, heading_cosine,
               start_angle, start_x, start_y, meal, death_draw, energy_eaten, energy_basic, energy_action,
               energy_forgiven, energy_capped, starved, breeds, dies, finding, eater, eater_distance, parent,
               parent_key)
};

struct World {
  const WorldConfig* config;
  const WorldShape* shape;
  const WorldConstants* constants;
  const Kernel* kernel;
  uint64_t seed;
  WorldState state;
  PhysicsScratch physics_scratch;
  StepScratch scratch;
  RayScene scene;

  HEDON_FN WorldHead& head() const { return state.head[0]; }
  HEDON_FN Counters& counters() const { return state.counters[0]; }
  HEDON_FN Fault& fault() const { return state.fault[0]; }
  /// The step at which the window of the current step began.
  HEDON_FN int64_t window_start() const { return head().step - head().step % shape->steps; }
  HEDON_FN bool over() const { return head().extinct_step >= 0 || fault().status != Status::ok; }

  /// Keeps the first error; later ones are usually its consequences.
  HEDON_FN void fail(Status status, int32_t agent_id, double value, int32_t other_id = -1) const {
    if (fault().status == Status::ok) fault() = {status, agent_id, head().step, value, other_id, 0};
  }

  HEDON_FN float* params(int32_t slot) const { return &state.params[int64_t{slot} * shape->network.size()]; }
  /// What the agent in `slot` acts with.
  HEDON_FN ActingNetwork network(int32_t slot) const {
    const bool rounded = config->learning.acting_weights == ActingWeights::bfloat16;
    float* packed_weights = rounded ? &state.packed_weights[int64_t{slot} * shape->network.pairs()] : nullptr;
    return {params(slot), &state.folded_bias[int64_t{slot} * HIDDEN], packed_weights};
  }
  HEDON_FN float* genome(int32_t slot) const { return &state.genome[int64_t{slot} * shape->genome.size()]; }
  HEDON_FN int32_t* meal(int32_t slot) const { return &scratch.meal[int64_t{slot} * shape->kinds]; }
  HEDON_FN PackedObservation& observation(int32_t slot, int64_t t) const {
    return state.observation[slot * (int64_t{shape->steps} + 1) + t];
  }
};

}  // namespace hedon
