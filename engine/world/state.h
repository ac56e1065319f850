/// The whole state of a world at one moment: read this first.
///
/// Agents live in *slots*, which are used again after a death; an `agent_id` never is. `living` lists the slots of the
/// living in the order of their ids. Every sum and every loop whose order matters uses this order, so that results do
/// not depend on slots. Loops in which agents do not affect one another use the order of slots, that is, of memory
/// (`list_by_slot`).
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"
#include "base/status.h"
#include "learning/observation.h"
#include "physics/state.h"
#include "world/config.h"
#include "world/shape.h"

namespace hedon {

/// One life: the data of an agent for the records. Updated while it lives.
struct Life {
  int64_t birth_step;
  int64_t death_step;  ///< -1 while alive
  int32_t agent_id;
  int32_t parent_id;  ///< -1 for founders
  int32_t generation;
  int32_t children;
  double energy;         ///< held now, or at death
  double birth_energy;   ///< held at birth
  double energy_gained;  ///< by eating, including energy lost at the capacity
  double energy_spent;   ///< on living and moving, including energy forgiven at zero
  double distance;       ///< moved [u]
  double force_left;     ///< summed over the steps lived
  double force_right;
  double reward;  ///< summed over the steps lived

  HEDON_FIELDS(Life, birth_step, death_step, agent_id, parent_id, generation, children, energy, birth_energy,
               energy_gained, energy_spent, distance, force_left, force_right, reward)
};

/// Sums since the world began. The ledger (double) counts all energy that agents gained or lost.
struct Counters {
  int64_t births;
  int64_t deaths;
  int64_t births_failed_full;   ///< all slots taken
  int64_t births_failed_space;  ///< no free place found
  int64_t agent_steps;
  int64_t learners;  ///< agent-windows learned from
  double energy_initial;
  double energy_eaten;
  double energy_basic;
  double energy_action;
  double energy_forgiven;  ///< spending that an agent at zero could not pay
  double energy_capped;    ///< eaten but lost at the capacity
  double energy_shared;    ///< given by parents to children: neither gained nor lost
  double energy_lost;      ///< held by agents when they died

  HEDON_FIELDS(Counters, births, deaths, births_failed_full, births_failed_space, agent_steps, learners, energy_initial,
               energy_eaten, energy_basic, energy_action, energy_forgiven, energy_capped, energy_shared, energy_lost)
};

/// Growth of one food kind.
struct FoodStock {
  double number;    ///< the internal number n_t; its floor is the intended number of foods
  int64_t eaten;    ///< since the world began
  int32_t present;  ///< foods in the arena
  int32_t center;   ///< the Gaussian in use, for switching placement

  HEDON_FIELDS(FoodStock, number, eaten, present, center)
};

/// Single numbers of a world.
struct WorldHead {
  int64_t step;          ///< steps completed
  int64_t extinct_step;  ///< -1 while any agent lives
  int32_t next_agent_id;
  int32_t living_count;
  int32_t free_count;
  int32_t births_in_window;
  int32_t births_before;  ///< of the window before
  int32_t ghost_count;
  int32_t event_count;  ///< deaths not yet taken by the reader
  int32_t reserved;

  HEDON_FIELDS(WorldHead, step, extinct_step, next_agent_id, living_count, free_count, births_in_window, births_before,
               ghost_count, event_count, reserved)
};

/// A birth of this window whose genome is drawn at the window's end.
struct Newborn {
  int32_t agent_id;
  int32_t parent;  ///< index of its parent among the newborns; -1 if the parent is older than the window

  HEDON_FIELDS(Newborn, agent_id, parent)
};

/// A food eaten in the last step that rays still meet.
struct Ghost {
  float x, y;
  int32_t kind;

  HEDON_FIELDS(Ghost, x, y, kind)
};

struct WorldState {
  Array<WorldHead> head;     // (1)
  Array<Fault> fault;        // (1) the first error
  Array<Counters> counters;  // (1)

  // Agents, by slot.
  Array<uint8_t> alive;   // (slots)
  Array<int32_t> living;  // (slots) slots of the living in the order of their ids
  Array<int32_t> free;    // (slots) stack of free slots
  Array<Life> life;       // (slots)
  Array<int32_t> eaten;   // (slots, kinds) foods eaten in this life
  Array<float> genome;    // (slots, genes)
  Array<uint64_t> touch;  // (slots) bit type * sectors + sector, of the last step
  PhysicsState physics;   // bodies by slot; foods as circles, of which kind k owns a fixed range; walls; impulses

  Array<FoodStock> food_stock;  // (kinds)
  Array<Ghost> ghost;           // (foods) none unless eaten food is seen

  // Rules of birth that reach over a window; none unless the config has them.
  Array<uint8_t> old_slot;      // (slots) 1 for slots that were taken when the window began
  Array<Newborn> newborn;       // (births) of this window, in the order of birth
  Array<float> newborn_genome;  // (births, genes) of each newborn's parent, if that is older than the window

  // Learners, by slot.
  Array<float> params;          // (slots, params)
  Array<float> folded_bias;     // (slots, 64) derived from params
  Array<float> packed_weights;  // (slots, pairs) derived from params; none where agents act with params themselves
  Array<float> first_moment;    // (slots, params)
  Array<float> second_moment;   // (slots, params)
  Array<int64_t> updates;       // (slots) Adam steps done in this life

  // Rollouts of the current window, by slot, then by step. The one extra observation is for the bootstrap.
  Array<PackedObservation> observation;  // (slots, rollout_steps + 1)
  Array<float> action;                   // (slots, rollout_steps, 2) before the sigmoid
  Array<float> log_prob;                 // (slots, rollout_steps)
  Array<float> value;                    // (slots, rollout_steps)
  Array<float> reward;                   // (slots, rollout_steps)

  // Deaths that the reader has not yet taken.
  Array<Life> event;           // (events)
  Array<int32_t> event_eaten;  // (events, kinds)
  Array<float> event_genome;   // (events, genes)

  HEDON_FIELDS(WorldState, head, fault, counters, alive, living, free, life, eaten, genome, touch, physics, food_stock,
               ghost, old_slot, newborn, newborn_genome, params, folded_bias, packed_weights, first_moment,
               second_moment, updates, observation, action, log_prob, value, reward, event, event_eaten, event_genome)
};

}  // namespace hedon
