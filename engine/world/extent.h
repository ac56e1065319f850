/// The sizes of a world's arrays, and the lifetimes of their contents. `HEDON_ARRAYS` names both for each array.
#pragma once

#include <cstdint>

#include "kernel/kernel.h"
#include "learning/network.h"
#include "world/shape.h"

namespace hedon {

/// A number of rows, or of values in a row.
enum class Extent : uint8_t {
  one,
  slots,
  mixed_slots,     ///< slots, if there are several species
  own_slots,       ///< slots, if genes set numbers of some species
  resident_slots,  ///< slots, if only agents in slots that were taken when the window began have children
  network_slots,   ///< slots, if some species acts by networks; of other species they are not used
  learner_slots,   ///< slots, if some species learns; of other species they are not used
  external_slots,  ///< slots, if the caller controls some species
  ruled_slots,     ///< slots, if some species has a rule of the caller
  packed_slots,    ///< slots, if some act with weights in pairs
  species,
  eaters,  ///< the same, if there are several or one that eats its own kind
  kinds,
  foods,
  eaten_foods,     ///< foods, if those just eaten are seen
  newborns,        ///< births that wait for their genomes
  mixed_newborns,  ///< the same, if there are several species
  death_log,       ///< deaths that wait for the reader
  walls,
  obstacles,
  obstacle_slots,    ///< slots, if there are obstacles
  harmed,            ///< species, if there are obstacles
  obstacle_corners,  ///< two numbers for each corner of an obstacle
  circles,
  query_circles,  ///< circles, if some species has queries about its neighbors
  cell_ends,      ///< cells of the ray grid, and one
  candidates,     ///< for each member of a team: lists of circles that its rays may hit
  genes,
  params,
  pairs,
  hidden,
  actions,
  instinct_slots,    ///< slots, if some species passes on the networks that it was born with
  mating_slots,      ///< slots, if some species has two parents
  mating_death_log,  ///< the same, if some species has two parents
  store_slots,       ///< slots, if some species has a store other than energy
  store_death_log,   ///< deaths that wait for the reader, if some species has a store other than energy
  last_slots,        ///< slots, if some species observes values of the previous step
  birth_slots,       ///< slots, if some species senses, or is rewarded for, its children
  last,              ///< most values of a step that are kept for the next observation
  stores,            ///< most stores of a species
  more_stores,       ///< the same without energy
  scents,            ///< smells of an agent: channels times noses
  memory,            ///< numbers that a rule keeps for each agent
  record,            ///< numbers that a rule gets for one agent
  near,              ///< most queries of a species
  steps,             ///< of a rollout
  step_actions,      ///< actions of a rollout
  observations,      ///< cache lines of the observations of a rollout, and of the one after it
  wide_slots,        ///< slots, if some observations are wide
  hunted_slots,      ///< slots, if some species eats agents
  claims,            ///< claims of eaters on prey in a step: one for each agent, or several
  deaths,            ///< species, if agents can die of causes other than age and energy
  meals,             ///< what an agent can eat: food kinds, and species if some species eats agents
};

/// How long the contents of an array last.
enum class Lifetime : uint8_t {
  saved,    ///< the state: in checkpoints and digests
  rollout,  ///< the same, for agents that will learn from the window
  derived,  ///< follows from the saved arrays: computed again after a restore
  waiting,  ///< for the reader of the records
  scratch,  ///< not valid between steps
};

/// Whether an array with these rows has one for each slot, or none at all.
HEDON_FN bool is_by_slot(Extent rows) {
  return rows == Extent::slots || rows == Extent::mixed_slots || rows == Extent::own_slots ||
         rows == Extent::resident_slots || rows == Extent::network_slots || rows == Extent::learner_slots ||
         rows == Extent::external_slots || rows == Extent::ruled_slots || rows == Extent::packed_slots ||
         rows == Extent::wide_slots || rows == Extent::obstacle_slots || rows == Extent::store_slots ||
         rows == Extent::instinct_slots || rows == Extent::mating_slots || rows == Extent::hunted_slots ||
         rows == Extent::last_slots || rows == Extent::birth_slots;
}

/// Whether an array with these rows has one for each death that waits for the reader, or none at all.
HEDON_FN bool is_by_death(Extent rows) {
  return rows == Extent::death_log || rows == Extent::mating_death_log || rows == Extent::store_death_log;
}

struct ArrayShape {
  Extent rows, width;
  Lifetime lifetime;
};

/// Whether an array is large and needed only for learning: moments and observations.
constexpr HEDON_INLINE bool is_cold(ArrayShape size) {
  return size.width == Extent::observations || (size.rows == Extent::learner_slots && size.width == Extent::params);
}

/// How many agents ahead cold arrays are prefetched.
inline constexpr int32_t AHEAD = 8;

/// members   of the team that steps the world
HEDON_FN int64_t extent(const WorldShape& shape, Extent of, int64_t members) {
  switch (of) {
    case Extent::one:
      return 1;
    case Extent::slots:
      return shape.capacity;
    case Extent::mixed_slots:
      return shape.species > 1 ? shape.capacity : 0;
    case Extent::own_slots:
      return shape.own ? shape.capacity : 0;
    case Extent::resident_slots:
      return shape.resident_slots ? shape.capacity : 0;
    case Extent::network_slots:
      return shape.networks ? shape.capacity : 0;
    case Extent::learner_slots:
      return shape.learning ? shape.capacity : 0;
    case Extent::external_slots:
      return shape.external ? shape.capacity : 0;
    case Extent::ruled_slots:
      return shape.ruled ? shape.capacity : 0;
    case Extent::packed_slots:
      return shape.packed ? shape.capacity : 0;
    case Extent::species:
      return shape.species;
    case Extent::eaters:
      return shape.species > 1 || shape.hunting ? shape.species : 0;
    case Extent::kinds:
      return shape.kinds;
    case Extent::foods:
      return shape.foods;
    case Extent::eaten_foods:
      return shape.shows_eaten_food ? shape.foods : 0;
    case Extent::newborns:
      return shape.newborns;
    case Extent::mixed_newborns:
      return shape.species > 1 ? shape.newborns : 0;
    case Extent::death_log:
      return shape.death_log_rows;
    case Extent::walls:
      return shape.walls;
    case Extent::obstacles:
      return shape.obstacles;
    case Extent::obstacle_slots:
      return shape.obstacles > 0 ? shape.capacity : 0;
    case Extent::harmed:
      return shape.obstacles > 0 ? shape.species : 0;
    case Extent::obstacle_corners:
      return shape.obstacles > 0 ? 2 * (shape.walls - shape.first_obstacle) / shape.obstacles : 0;
    case Extent::circles:
      return shape.circles;
    case Extent::query_circles:
      return shape.near > 0 ? shape.circles : 0;
    case Extent::cell_ends:
      return int64_t{shape.scene.columns} * shape.scene.rows + 1;
    case Extent::candidates:
      return members * RAY_ARCS * (int64_t{shape.circles} + 16);
    case Extent::genes:
      return shape.genes;
    case Extent::params:
      return shape.params;
    case Extent::pairs:
      return shape.pairs;
    case Extent::hidden:
      return HIDDEN;
    case Extent::instinct_slots:
      return shape.instinct ? shape.capacity : 0;
    case Extent::mating_slots:
      return shape.mating ? shape.capacity : 0;
    case Extent::mating_death_log:
      return shape.mating ? shape.death_log_rows : 0;
    case Extent::store_slots:
      return shape.stores > 1 ? shape.capacity : 0;
    case Extent::store_death_log:
      return shape.stores > 1 ? shape.death_log_rows : 0;
    case Extent::last_slots:
      return shape.last > 0 ? shape.capacity : 0;
    case Extent::birth_slots:
      return shape.counts_births ? shape.capacity : 0;
    case Extent::last:
      return shape.last;
    case Extent::stores:
      return shape.stores;
    case Extent::more_stores:
      return shape.stores - 1;
    case Extent::scents:
      return shape.scents;
    case Extent::memory:
      return shape.memory;
    case Extent::record:
      return shape.record;
    case Extent::near:
      return shape.near;
    case Extent::actions:
      return ACTIONS;
    case Extent::steps:
      return shape.rollout;
    case Extent::step_actions:
      return int64_t{shape.rollout} * ACTIONS;
    case Extent::observations:
      return (int64_t{shape.rollout} + 1) * shape.lines;
    case Extent::wide_slots:
      return shape.lines > NARROW_LINES ? shape.capacity : 0;
    case Extent::hunted_slots:
      return shape.hunting ? shape.capacity : 0;
    case Extent::claims:
      return shape.claims;
    case Extent::deaths:
      return shape.causes ? shape.species : 0;
    case Extent::meals:
      return shape.meals();
  }
  return 0;
}

}  // namespace hedon
