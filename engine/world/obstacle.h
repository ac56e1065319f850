/// Obstacles: regular polygons, whose places depend only on the config and the seed of the world, and their harm.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "base/random.h"
#include "world/placement.h"
#include "world/schedule.h"
#include "world/world.h"

namespace hedon {

/// Maximum number of draws for the place of one obstacle.
inline constexpr uint32_t OBSTACLE_TRIES = 20000;

/// One polygon, described by the circle through its corners.
struct Polygon {
  Vec2 center;
  float radius, angle;
};

HEDON_FN Vec2 corner_of(const Polygon& polygon, int32_t corner, int32_t corners) {
  double sine, cosine;
  sincos_double(static_cast<double>(polygon.angle) - 2.0 * PI * corner / corners, &sine, &cosine);
  return {polygon.center.x + polygon.radius * static_cast<float>(cosine),
          polygon.center.y + polygon.radius * static_cast<float>(sine)};
}

/// Whether obstacle `i` may be here: its circle is inside the arena, and clear of inner walls and earlier obstacles. On
/// a grid, its cell must be empty.
HEDON_FN bool may_stand(const World& world, const Polygon& polygon, int32_t i, const Vec2* centers,
                        const float* radii) {
  const float cell = world.config->obstacle.cell;
  bool may = cell > 0.0f || clear_of_walls(world, polygon.center, polygon.radius, world.shape->first_obstacle);
  for (int32_t other = 0; other < i && may; ++other) {
    const float reach = cell > 0.0f ? 0.5f * cell : polygon.radius + radii[other];
    may = squared_length(centers[other] - polygon.center) >= reach * reach;
  }
  return may;
}

/// The middle of the cell of a grid from 0 to `end` at `share` of it.
HEDON_FN float middle_of_cell(float cell, float end, float share) {
  const int32_t count = static_cast<int32_t>(end / cell), at = static_cast<int32_t>(share * static_cast<float>(count));
  return cell * (static_cast<float>(at < count ? at : count - 1) + 0.5f);
}

/// Draws a place for obstacle `i`.
HEDON_FN bool find_obstacle_place(const World& world, int32_t i, const Vec2* centers, const float* radii,
                                  Polygon* polygon) {
  const ObstacleConfig& config = world.config->obstacle;
  const RandomStream random{world.seed, Purpose::obstacle, static_cast<uint32_t>(i), 0};
  double sine, cosine;
  sincos_double(PI / config.corners, &sine, &cosine);
  const float per_side = static_cast<float>(0.5 / sine);
  for (uint32_t k = 0; k < OBSTACLE_TRIES; ++k) {
    const Random4 bits = random.draw(k);
    const float side = config.min_side + (config.max_side - config.min_side) * to_uniform(bits.word[3]);
    const ArenaConfig& arena = world.config->arena;
    const float x = to_uniform(bits.word[0]), y = to_uniform(bits.word[1]);
    const bool free = !(config.cell > 0.0f);
    *polygon = {{free ? arena.width * x : middle_of_cell(config.cell, arena.width, x),
                 free ? arena.height * y : middle_of_cell(config.cell, arena.height, y)},
                side * per_side,
                config.min_angle + (config.max_angle - config.min_angle) * to_uniform(bits.word[2])};
    if (may_stand(world, *polygon, i, centers, radii)) return true;
  }
  return false;
}

/// Appends the obstacles of a world to its other walls. Their sides run clockwise, so their inside is to the right.
HEDON_FN void place_obstacles(World& world) {
  const int32_t corners = world.config->obstacle.corners;
  Vec2 centers[MAX_OBSTACLES];
  float radii[MAX_OBSTACLES];
  for (int32_t i = 0; i < world.shape->obstacles; ++i) {
    Polygon polygon;
    if (!find_obstacle_place(world, i, centers, radii, &polygon)) return world.fail(Status::initial_placement, -1, i);
    centers[i] = polygon.center;
    radii[i] = polygon.radius;
    for (int32_t c = 0; c < corners; ++c) {
      const Vec2 corner = corner_of(polygon, c, corners);
      float* const kept = &world.state.obstacle[(int64_t{i} * corners + c) * 2];
      kept[0] = corner.x;
      kept[1] = corner.y;
      world.state.physics.walls[world.shape->first_obstacle + i * corners + c] = {
          corner, corner_of(polygon, (c + 1) % corners, corners)};
    }
  }
}

/// How many obstacles are harmful now: the first ones in the list.
HEDON_FN int32_t harmful_obstacles(const World& world) {
  const ObstacleConfig& config = world.config->obstacle;
  return static_cast<int32_t>(factor_at(config.schedule.harmful, world.head().step) * config.count + 0.5);
}

/// Counts the harmful obstacles that each agent touched in this step, each once for all of its sides.
HEDON_FN void count_obstacle_contacts(World& world) {
  const PairList& pairs = world.state.physics.neighbors.walls;
  const NeighborList& list = world.state.physics.neighbors;
  for (int32_t i = 0; i < world.head().living_count; ++i) world.scratch.touched[world.state.living[i]] = 0;
  const int32_t harmful = harmful_obstacles(world);
  // The walls of a body are listed in order, so the sides of an obstacle are consecutive.
  int32_t body = -1, last = -1;
  for (int32_t pair = 0; pair < pairs.start[list.head[0].bodies]; ++pair) {
    if (pairs.mark[pair] == 0) continue;
    const int32_t obstacle = (pairs.second[pair] - world.shape->first_obstacle) / world.config->obstacle.corners;
    if (obstacle >= harmful || (pairs.first[pair] == body && obstacle == last)) continue;
    body = pairs.first[pair];
    last = obstacle;
    world.scratch.touched[list.slot[body]] += 1;
  }
}

}  // namespace hedon
