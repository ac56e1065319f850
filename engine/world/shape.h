/// Sizes that follow from a config: computed once, never changed.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/math.h"
#include "config/config.h"
#include "physics/state.h"
#include "world/own.h"
#include "world/species.h"

namespace hedon {

/// The grid for sorting the circles that rays may hit.
struct RayGrid {
  float inverse_cell;  ///< cells per length [1/u]
  int32_t columns;
  int32_t rows;
};

/// Cells are a third as wide as the longest ray, so that the cells around a fan are few and hold few other circles.
/// They are wider if an arena is so empty that there would be more cells than circles.
HEDON_FN RayGrid make_ray_grid(const Config& config, int32_t circles) {
  const float width = config.arena.width, height = config.arena.height;
  float reach = 0.0f;
  for (int32_t s = 0; s < config.species.count; ++s) {
    const float own = (config.species[s].body.radius + config.species[s].sensor.ray_length) / 3.0f;
    reach = own > reach ? own : reach;
  }
  const float even = sqrtf(width * height / static_cast<float>(circles));
  const float inverse_cell = 1.0f / (reach > even ? reach : even);
  return {inverse_cell, static_cast<int32_t>(width * inverse_cell) + 1,
          static_cast<int32_t>(height * inverse_cell) + 1};
}

struct WorldShape {
  int32_t capacity;  ///< most agents alive at a time, all species
  int32_t species;
  int32_t kinds;  ///< food kinds
  int32_t foods;  ///< most foods present at a time, all kinds
  int32_t walls;
  int32_t outer_walls;     ///< the first walls, a closed convex polygon
  int32_t first_obstacle;  ///< walls from here on are the sides of obstacles
  int32_t obstacles;
  int32_t circles;         ///< most circles that rays may hit: agents, foods, and foods just eaten if they are seen
  int32_t death_log_rows;  ///< deaths that can wait for the reader
  int32_t newborns;        ///< births of a window that can wait for their genomes
  int32_t steps;           ///< of a window
  int32_t rollout;         ///< steps kept in a rollout: a whole window, or 1 if no species learns
  int32_t genes;           ///< of the longest genome: the length of a row
  int32_t params;          ///< of the largest network
  int32_t pairs;           ///< of weights of the largest network
  bool shows_eaten_food;   ///< eaten food is seen for one step
  bool resident_slots;     ///< only agents in slots that were taken when the window began have children
  bool networks;           ///< some species acts by networks
  bool learning;           ///< some species learns
  bool external;           ///< the caller controls some species
  bool ruled;              ///< rules of the caller decide rewards, deaths or births of some species
  int32_t memory;          ///< most numbers that a rule keeps for each agent
  int32_t record;          ///< of the longest record that a rule gets
  int32_t near;            ///< most queries of a species
  int32_t last;            ///< most values of a step that are kept for the next observation
  bool counts_births;      ///< some species senses, or is rewarded for, its children
  int32_t scents;          ///< of the longest row of smells: channels times noses
  bool packed;             ///< some species acts with weights in pairs
  bool own;                ///< genes set numbers of some species, so its agents have individual values
  bool instinct;           ///< some species passes on the networks that it was born with
  bool mating;             ///< some species has two parents
  int32_t stores;          ///< most stores of a species
  bool gated;              ///< some species must hold something to eat some food
  bool hunting;            ///< some species eats agents, of another species or its own
  int32_t claims;          ///< most claims of eaters on their prey in a step
  bool causes;             ///< agents die of causes other than age and energy: some starve at once, or are eaten
  int32_t lines;           ///< cache lines of an observation
  int32_t food_offset[MAX_FOOD_KINDS + 1];  ///< kind k owns food slots [offset[k], offset[k + 1])
  RayGrid scene;
  float most_energy[MAX_SPECIES];  ///< largest capacity of an agent of each species
  Species of[MAX_SPECIES];
  BodyTable bodies;

  /// What an agent can eat: food kinds, then species.
  HEDON_FN int32_t meals() const { return kinds + (hunting ? species : 0); }
  HEDON_FN int32_t food_type(int32_t kind) const { return species + kind; }
  HEDON_FN int32_t wall_type() const { return species + kinds; }
  HEDON_FN int32_t obstacle_type() const { return wall_type() + 1; }
  HEDON_FN int32_t types() const { return species + kinds + (obstacles > 0 ? 2 : 1); }
  HEDON_FN int32_t type_of_wall(int32_t wall) const { return wall < first_obstacle ? wall_type() : obstacle_type(); }
  HEDON_FN int32_t species_of(int32_t slot) const {
    int32_t s = 0;
    while (slot >= of[s].last_slot) ++s;
    return s;
  }
};

/// Deaths per slot that can wait for the reader. The host loop reads a few times per second, about every thousand
/// steps, in which about one agent in ten dies.
inline constexpr int LOGGED_DEATHS_PER_SLOT = 16;

/// The classes of the physics: one per species, one per food kind.
HEDON_FN BodyTable make_body_table(const Config& config, const WorldShape& shape) {
  BodyTable table{};
  table.classes = shape.species;
  table.circle_classes = shape.kinds;
  table.circle_radius = config.world.food_radius;
  table.first_obstacle = shape.first_obstacle;
  table.obstacle = {config.obstacle.friction, config.obstacle.restitution};
  for (int32_t k = 0; k <= shape.kinds; ++k) table.first_circle[k] = shape.food_offset[k];
  for (int32_t s = 0; s < shape.species; ++s) {
    table.first_slot[s + 1] = shape.of[s].last_slot;
    table.set_shape(s, shape.of[s].body);
    if (sets_body(shape.of[s].layout)) {
      table.own = 1;
      table.smallest[s] = extreme(shape.of[s], -1.0f).body;
      table.largest[s] = extreme(shape.of[s], 1.0f).body;
    }
    const FixedList<int32_t, MAX_TYPES>& touches = config.layout[s].touches;
    for (int32_t c = 0; c < touches.count; ++c) {
      const int32_t type = touches[c];
      if (type < shape.species) table.meets_bodies[s] |= 1u << type;
      if (type >= shape.species && type < shape.wall_type()) table.meets_circles[s] |= 1u << (type - shape.species);
    }
  }
  return table;
}

/// Most claims in a step: one per agent, or one in each direction per pair of bodies that the physics keeps.
HEDON_FN int32_t count_claims(const Config& config, const WorldShape& shape) {
  if (config.world.prey_at_mouth == WorldPreyAtMouth::nearest) return shape.capacity;
  return static_cast<int32_t>(2 * physics_capacity(shape.capacity, shape.foods, shape.walls, config.arena.width,
                                                   config.arena.height, shape.bodies, config.physics)
                                      .body_pairs);
}

HEDON_FN WorldShape make_shape(const Config& config, int32_t walls, int32_t outer_walls) {
  WorldShape shape{};
  const auto grow = [](int32_t& most, int32_t value) { most = value > most ? value : most; };
  shape.species = config.species.count;
  shape.kinds = config.food.count;
  shape.obstacles = config.obstacle.count;
  for (int32_t s = 0; s < shape.species; ++s) {
    const SpeciesConfig& own = config.species[s];
    const SpeciesLayout& layout = config.layout[s];
    const Species& species = shape.of[s] = make_species(own, layout, shape.capacity, shape.types());
    shape.capacity = species.last_slot;
    shape.own |= layout.sets.count > 0;
    shape.most_energy[s] = extreme(species, 1.0f).config.energy.capacity;
    shape.instinct |= species.learns && own.birth.network == BirthNetwork::initial;
    shape.mating |= own.birth.mating == BirthMating::pairs;
    grow(shape.stores, species.stores());
    for (int32_t i = 0; i < layout.needs.count; ++i) shape.gated |= layout.needs[i] > 0.0f;
    grow(shape.scents, layout.smells.count * own.sensor.noses);
    grow(shape.last, layout.last.count);
    grow(shape.near, layout.neighbors.count);
    layout.for_each_channel([&](const Channel& each) { shape.counts_births |= each.source == ChannelSource::births; });
    grow(shape.genes, layout.genes.count);
    grow(shape.params, species.network.size());
    grow(shape.pairs, species.network.pairs());
    grow(shape.lines, species.network.observation.wide() ? WIDE_LINES : NARROW_LINES);
    for (int32_t prey = 0; prey < layout.eats_species.count; ++prey) shape.hunting |= layout.eats_species[prey] > 0.0f;
    shape.causes |= shape.hunting;
    for (int32_t i = 0; i < species.stores(); ++i) shape.causes |= store_of(own, i).at_zero == StoreAtZero::death;
    if (layout.has_rule()) {
      shape.ruled = true;
      grow(shape.memory, own.reward.memory);
      grow(shape.record, species.record);
    }
    shape.networks |= species.has_network;
    shape.learning |= species.learns;
    shape.external |= own.learning.policy == LearningPolicy::external;
    shape.packed |= species.has_network && own.learning.acting_weights == LearningActingWeights::bfloat16;
  }
  for (int32_t s = 0; s < shape.species; ++s) shape.of[s].network.observation.lines = shape.lines;
  shape.first_obstacle = walls;
  shape.walls = walls + config.obstacle.count * config.obstacle.corners;
  shape.outer_walls = outer_walls;
  shape.death_log_rows = LOGGED_DEATHS_PER_SLOT * shape.capacity;
  shape.steps = config.world.rollout_steps;
  shape.rollout = shape.learning ? shape.steps : 1;
  for (int32_t k = 0; k < shape.kinds; ++k) shape.food_offset[k + 1] = shape.food_offset[k] + config.food[k].capacity;
  shape.foods = shape.food_offset[shape.kinds];
  shape.shows_eaten_food = config.world.eaten_food == WorldEatenFood::seen;
  shape.resident_slots = config.world.parents == WorldParents::resident_slots;
  shape.circles = shape.capacity + shape.foods + (shape.shows_eaten_food ? shape.foods : 0);
  shape.newborns = config.world.inheritance == WorldInheritance::at_window_end ? shape.death_log_rows : 0;
  shape.scene = make_ray_grid(config, shape.capacity + shape.foods);
  shape.bodies = make_body_table(config, shape);
  shape.claims = shape.hunting ? count_claims(config, shape) : 0;
  return shape;
}

}  // namespace hedon
