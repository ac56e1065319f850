/// How food grows, where it appears, and which agent eats it.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "world/placement.h"
#include "world/schedule.h"
#include "world/store.h"
#include "world/world.h"

namespace hedon {

/// The current position of a drifting center.
HEDON_FN Vec2 center_at(const World& world, const PlacementConfig& placement, int32_t center) {
  const auto moved = [&](float start, float drift, float side) {
    const double now = static_cast<double>(start) + static_cast<double>(drift) * static_cast<double>(world.head().step);
    return now < 0.0 ? 0.0f : (now > side ? side : static_cast<float>(now));
  };
  const Vec2 start = placement.centers[center];
  const ArenaConfig& arena = world.config->arena;
  return {moved(start.x, placement.drift.x, arena.width), moved(start.y, placement.drift.y, arena.height)};
}

/// A candidate position for a food of kind `k`; it may be outside the arena.
HEDON_FN Vec2 draw_food_position(const World& world, int32_t k, const RandomStream& random, uint32_t index) {
  const PlacementConfig& placement = world.config->food[k].placement;
  const Random4 bits = random.draw(index);
  if (placement.form == PlacementForm::uniform) {
    return {world.config->arena.width * to_uniform(bits.word[0]),
            world.config->arena.height * to_uniform(bits.word[1])};
  }
  const bool any = placement.form == PlacementForm::mixture;
  const int32_t center =
      any ? static_cast<int32_t>(to_index(bits.word[2], placement.centers.count)) : world.state.food_stock[k].center;
  const Vec2 middle = center_at(world, placement, center);
  if (placement.form == PlacementForm::rectangle) {
    return {middle.x + placement.sd.x * (2.0f * to_uniform(bits.word[0]) - 1.0f),
            middle.y + placement.sd.y * (2.0f * to_uniform(bits.word[1]) - 1.0f)};
  }
  const NormalPair normal = to_normal(bits.word[0], bits.word[1]);
  return {middle.x + placement.sd.x * normal.first, middle.y + placement.sd.y * normal.second};
}

/// Whether a place is far enough from the other foods of kind `k`.
HEDON_FN bool has_spacing(const World& world, int32_t k, Vec2 position) {
  const float spacing = world.config->food[k].placement.spacing;
  if (!(spacing > 0.0f)) return true;
  const auto& foods = world.state.physics.circles;
  for (int32_t f = world.shape->food_offset[k]; f < world.shape->food_offset[k + 1]; ++f) {
    const Vec2 apart{foods.x[f] - position.x, foods.y[f] - position.y};
    if (foods.present[f] != 0 && squared_length(apart) < spacing * spacing) return false;
  }
  return true;
}

/// Puts a food of kind `k` into a free slot of its kind.
HEDON_FN void place_food(World& world, int32_t k, Vec2 position) {
  WorldState& state = world.state;
  int32_t f = world.shape->food_offset[k];
  while (state.physics.circles.present[f]) ++f;
  state.physics.circles.x[f] = position.x;
  state.physics.circles.y[f] = position.y;
  state.physics.circles.present[f] = 1;
  state.food_stock[k].present += 1;
  insert(state.physics.circle_grid, f, position.x, position.y);
  mark_stale(state.physics);
}

/// Tries to place a food of kind `k` at candidate number `i`; returns whether it was placed.
HEDON_FN bool try_food(World& world, int32_t k, const RandomStream& random, uint32_t i) {
  const Vec2 position = draw_food_position(world, k, random, i);
  if (!has_spacing(world, k, position) || !can_place(world, position, world.config->world.food_radius)) return false;
  place_food(world, k, position);
  return true;
}

/// Tries up to `candidates` places, until the number of foods present of kind `k` is the floor of its internal number.
HEDON_FN void place_missing_food(World& world, int32_t k, const RandomStream& random, int32_t candidates) {
  const FoodStock& stock = world.state.food_stock[k];
  for (int32_t i = 0; i < candidates && stock.present < static_cast<int32_t>(stock.number); ++i)
    try_food(world, k, random, static_cast<uint32_t>(i));
}

/// Places `count` foods of kind `k`, each with up to `tries` candidates; fewer if one finds no place.
HEDON_FN void place_first_food(World& world, int32_t k, const RandomStream& random, int32_t count, int32_t tries) {
  uint32_t i = 0;
  for (int32_t f = 0; f < count; ++f) {
    const uint32_t last = i + static_cast<uint32_t>(tries);
    while (!try_food(world, k, random, i++)) {
      if (i == last) return;
    }
  }
}

HEDON_FN int32_t food_kind(const WorldShape& shape, int32_t food) { return shape.bodies.circle_class(food); }

/// Feeds `slot` a food of kind `k`. With switching placement, the center changes after a number of meals.
HEDON_FN void feed(World& world, int32_t slot, int32_t k) {
  FoodStock& stock = world.state.food_stock[k];
  const PlacementConfig& placement = world.config->food[k].placement;
  world.meal(slot)[k] += 1;
  stock.eaten += 1;
  if (placement.form == PlacementForm::switching && stock.eaten % placement.switch_after == 0) {
    stock.center = (stock.center + 1) % placement.centers.count;
  }
}

/// Of the agents whose mouths touched a food in this step, the nearest eats it, or all of them do, except those that do
/// not hold what it needs.
HEDON_FN void share_food(World& world) {
  WorldState& state = world.state;
  StepScratch& scratch = world.scratch;
  const BodyState& body = state.physics.bodies;
  world.head().eaten_food_count = 0;
  const bool all = world.config->world.mouths == WorldMouths::all;
  const bool seen = world.shape->shows_eaten_food;
  int32_t found = 0;
  for_each_marked_circle(state.physics.neighbors, [&](int32_t slot, int32_t f) {
    if (!can_digest(world, slot, food_kind(*world.shape, f))) return;
    const Vec2 apart{state.physics.circles.x[f] - body.x[slot], state.physics.circles.y[f] - body.y[slot]};
    const float distance = squared_length(apart);
    if (all && scratch.eater[f] >= 0) return feed(world, slot, food_kind(*world.shape, f));
    if (scratch.eater[f] >= 0 && scratch.eater_distance[f] <= distance) return;
    if (scratch.eater[f] < 0) ++found;
    scratch.eater[f] = slot;
    scratch.eater_distance[f] = distance;
  });
  if (found == 0) return;
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    FoodStock& stock = state.food_stock[k];
    for (int32_t f = world.shape->food_offset[k]; f < world.shape->food_offset[k + 1]; ++f) {
      const int32_t slot = scratch.eater[f];
      if (slot < 0) continue;
      scratch.eater[f] = -1;
      state.physics.circles.present[f] = 0;
      remove(state.physics.circle_grid, f);
      mark_stale(state.physics);
      stock.present -= 1;
      stock.number -= 1.0;
      feed(world, slot, k);
      if (seen)
        state.eaten_food[world.head().eaten_food_count++] = {state.physics.circles.x[f], state.physics.circles.y[f], k};
    }
  }
}

/// Clears all meals of the last step, and lets agents eat.
template <class Crew>
HEDON_FN void eat(const Crew& crew, World& world) {
  crew.each(0, world.head().living_count, [&](int32_t i) {
    for (int32_t m = 0; m < world.shape->meals(); ++m) world.meal(world.state.living[i])[m] = 0;
  });
  crew.once([&] { share_food(world); });
}

/// n <- min(n + g - eaten, n_max), then new food up to the floor of n. `eat` has already subtracted the eaten food. If
/// the capacity falls, foods that are there stay until they are eaten.
HEDON_FN void grow(World& world) {
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    const FoodConfig& config = world.config->food[k];
    FoodStock& stock = world.state.food_stock[k];
    const int64_t step = world.head().step;
    const double most = factor_at(config.schedule.capacity, step) * config.capacity;
    stock.number += factor_at(config.schedule.growth_rate, step) * static_cast<double>(config.growth_rate);
    if (stock.number > most) stock.number = most;
    const RandomStream random{world.seed, Purpose::food_place, static_cast<uint32_t>(k),
                              static_cast<uint32_t>(world.head().step)};
    place_missing_food(world, k, random, config.candidates);
  }
}

}  // namespace hedon
