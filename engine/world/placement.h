/// Tests whether something new fits in a place: inside the arena, without overlap.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/vec2.h"
#include "physics/neighbor.h"
#include "world/world.h"

namespace hedon {

/// Whether a disc is completely inside the outer polygon (clockwise, convex) and touches none of the inner walls before
/// number `last_wall`.
HEDON_FN bool clear_of_walls(const World& world, Vec2 position, float radius, int32_t last_wall) {
  const Array<Segment>& walls = world.state.physics.walls;
  for (int32_t w = 0; w < world.shape->outer_walls; ++w) {
    // The outer walls run clockwise, so the inside is to their right.
    const Vec2 along = walls[w].b - walls[w].a;
    if (cross(position - walls[w].a, along) < radius * length(along)) return false;
  }
  for (int32_t w = world.shape->outer_walls; w < last_wall; ++w) {
    const Vec2 near = nearest_on_segment(walls[w].a, walls[w].b, position);
    if (squared_length(position - near) < radius * radius) return false;
  }
  return true;
}

/// Whether a point is inside an obstacle, whose sides run clockwise.
HEDON_FN bool in_obstacle(const World& world, Vec2 position) {
  const int32_t corners = world.config->obstacle.corners;
  for (int32_t i = 0; i < world.shape->obstacles; ++i) {
    const Segment* sides = &world.state.physics.walls[world.shape->first_obstacle + i * corners];
    int32_t within = 0;
    while (within < corners && cross(position - sides[within].a, sides[within].b - sides[within].a) >= 0.0f) ++within;
    if (within == corners) return true;
  }
  return false;
}

/// Whether a disc is inside the arena and touches no wall and no obstacle.
HEDON_FN bool inside_arena(const World& world, Vec2 position, float radius) {
  return clear_of_walls(world, position, radius, world.shape->walls) && !in_obstacle(world, position);
}

/// Whether a disc overlaps no living agent and no food present.
HEDON_FN bool free_of_bodies(const World& world, Vec2 position, float radius) {
  const WorldState& state = world.state;
  const PhysicsState& physics = state.physics;
  bool is_free = true;
  const BodyTable& bodies = world.shape->bodies;
  for_each_body_near(physics, position.x, position.y, radius + bodies.max_radius(), [&](int32_t slot) {
    const float agent_reach = radius + radius_of(physics, bodies, slot);
    const Vec2 apart{physics.bodies.x[slot] - position.x, physics.bodies.y[slot] - position.y};
    if (state.alive[slot] && squared_length(apart) < agent_reach * agent_reach) is_free = false;
  });
  const float food_reach = radius + world.config->world.food_radius;
  for_each_circle_near(physics, position.x, position.y, food_reach, [&](int32_t f) {
    const Vec2 apart{physics.circles.x[f] - position.x, physics.circles.y[f] - position.y};
    if (physics.circles.present[f] && squared_length(apart) < food_reach * food_reach) is_free = false;
  });
  return is_free;
}

HEDON_FN bool can_place(const World& world, Vec2 position, float radius) {
  return inside_arena(world, position, radius) && free_of_bodies(world, position, radius);
}

}  // namespace hedon
