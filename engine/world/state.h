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
#include "config/config.h"
#include "learning/observation.h"
#include "physics/state.h"
#include "world/extent.h"

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

/// Sums since the world began, of one species, in worlds where agents starve at once or eat agents.
struct HuntCounters {
  int64_t deaths_starved;
  int64_t deaths_eaten;
  double energy_hunted;  ///< gained by eating agents
  double energy_prey;    ///< held by agents of this species that were eaten: part of `energy_lost`

  HEDON_FIELDS(HuntCounters, deaths_starved, deaths_eaten, energy_hunted, energy_prey)
};

/// Sums since the world began, of one species, in worlds with obstacles.
struct ObstacleCounters {
  int64_t obstacles_touched;  ///< that did harm, each once per agent and step
  double energy_damage;       ///< cost of touching them

  HEDON_FIELDS(ObstacleCounters, obstacles_touched, energy_damage)
};

/// Why an agent died.
enum class Cause : int32_t { age_energy, starved, eaten };
inline constexpr const char* CAUSE_NAMES[] = {"age_energy", "starved", "eaten"};

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
  int32_t births_in_window;
  int32_t births_before;  ///< of the window before
  int32_t eaten_food_count;
  int32_t death_log_count;  ///< deaths that wait for the reader
  int64_t death_log_lost;   ///< older ones, which newer ones have replaced, since the reader last took any

  HEDON_FIELDS(WorldHead, step, extinct_step, next_agent_id, living_count, births_in_window, births_before,
               eaten_food_count, death_log_count, death_log_lost)
};

/// A birth of this window whose genome is drawn at the window's end.
struct Newborn {
  int32_t agent_id;
  int32_t parent;  ///< index of its parent among the newborns; -1 if the parent is older than the window

  HEDON_FIELDS(Newborn, agent_id, parent)
};

/// A food eaten in the last step that rays still meet.
struct EatenFood {
  float x, y;
  int32_t kind;

  HEDON_FIELDS(EatenFood, x, y, kind)
};

struct WorldState {
  Array<WorldHead> head;
  Array<Fault> fault;        // the first error
  Array<Counters> counters;  // by species
  Array<FoodStock> food_stock;

  // Agents, by slot. Each species owns a range of slots.
  Array<uint8_t> alive;
  Array<int32_t> living;      // slots of the living in the order of their ids
  Array<int32_t> free;        // free slots: a stack in each species' range
  Array<int32_t> free_count;  // by species
  Array<Life> life;
  Array<int32_t> eaten;   // foods, and agents of each species, eaten in this life
  Array<float> genome;    // past the end of a species' genome: 0
  Array<uint64_t> touch;  // bit channel * sectors + sector, of the last step
  PhysicsState physics;   // bodies by slot; foods as circles, of which kind k owns a fixed range; walls; impulses
  Array<int32_t> species;
  Array<Species> own;          // if genes set numbers: the agent's own species, which follows from its genome
  Array<uint64_t> touch_more;  // bits of touch from 64 on
  Array<int32_t> digestion;    // steps until an agent can eat another one
  Array<HuntCounters> hunt_counters;
  Array<int64_t> eaten_by;  // by species: meals of each kind since the world began

  Array<int64_t> ready_until;  // step until which an agent waits for a second parent
  Array<int32_t> mate_id;      // the second parent; -1 for founders
  Array<double> store;         // (slots, stores) amount in each store except energy; 0 past the stores of a species
  Array<float>
      obstacle;  // (obstacles, corners · 2) positions of their corners, which follow from the config and the seed
  Array<ObstacleCounters> obstacle_counters;

  Array<float> external_action;  // (slots, 2) actions set by the caller, before the sigmoid
  Array<double> memory;          // kept for each agent by the rule of its species
  Array<float> last;             // (slots, last) unscaled values of the last step that are observed in the next
  Array<int32_t> births;         // children that an agent had in the last step

  // Networks and learners, by slot.
  Array<float> params;
  Array<float> initial_params;  // the parameters that an agent was born with
  Array<float> folded_bias;     // derived from params
  Array<float> packed_weights;  // derived from params; not used if agents act with params themselves
  Array<float> first_moment;
  Array<float> second_moment;
  Array<int64_t> updates;  // Adam steps done in this life

  // For rules that span steps or windows.
  Array<EatenFood> eaten_food;
  Array<uint8_t> resident_slot;  // 1 for slots that were taken when the window began
  Array<Newborn> newborn;        // of this window, in the order of birth
  Array<int32_t> newborn_species;
  Array<float> newborn_genome;  // of each newborn's parent, if that is older than the window

  // Rollouts of the current window, by slot, then by step. The one extra observation is for the bootstrap.
  Array<ObservationLine> observation;
  Array<float> action;  // (…, 2) before the sigmoid
  Array<float> log_prob;
  Array<float> value;
  Array<float> reward;

  // Deaths that the reader has not yet taken: the newest of them, in a ring if some were lost.
  Array<Life> death_log;
  Array<int32_t> death_log_species;
  Array<int32_t> death_log_cause;
  Array<int32_t> death_log_mate;
  Array<int32_t> death_log_eaten;
  Array<float> death_log_genome;
  Array<double> death_log_store;  // amount in each store except energy

  HEDON_ARRAYS(WorldState, (head, one, one, saved), (fault, one, one, derived), (counters, species, one, saved),
               (food_stock, kinds, one, saved), (alive, slots, one, derived), (living, slots, one, derived),
               (free, slots, one, derived), (free_count, species, one, derived), (life, slots, one, saved),
               (eaten, slots, meals, saved), (genome, slots, genes, saved), (touch, slots, one, saved),
               (physics, one, one, saved), (species, mixed_slots, one, saved), (own, own_slots, one, derived),
               (touch_more, wide_slots, one, saved), (digestion, hunted_slots, one, saved),
               (hunt_counters, deaths, one, saved), (eaten_by, eaters, meals, saved),
               (ready_until, mating_slots, one, saved), (mate_id, mating_slots, one, saved),
               (store, store_slots, more_stores, saved), (obstacle, obstacles, obstacle_corners, derived),
               (obstacle_counters, harmed, one, saved), (external_action, external_slots, actions, saved),
               (memory, ruled_slots, memory, saved), (last, last_slots, last, saved), (births, birth_slots, one, saved),
               (params, network_slots, params, saved), (initial_params, instinct_slots, params, saved),
               (folded_bias, network_slots, hidden, derived), (packed_weights, packed_slots, pairs, derived),
               (first_moment, learner_slots, params, saved), (second_moment, learner_slots, params, saved),
               (updates, learner_slots, one, saved), (eaten_food, eaten_foods, one, saved),
               (resident_slot, resident_slots, one, saved), (newborn, newborns, one, saved),
               (newborn_species, mixed_newborns, one, saved), (newborn_genome, newborns, genes, saved),
               (observation, slots, observations, rollout), (action, slots, step_actions, rollout),
               (log_prob, slots, steps, rollout), (value, slots, steps, rollout), (reward, slots, steps, rollout),
               (death_log, death_log, one, waiting), (death_log_species, death_log, one, waiting),
               (death_log_cause, death_log, one, waiting), (death_log_mate, mating_death_log, one, waiting),
               (death_log_eaten, death_log, meals, waiting), (death_log_genome, death_log, genes, waiting),
               (death_log_store, store_death_log, more_stores, waiting))
};

}  // namespace hedon
