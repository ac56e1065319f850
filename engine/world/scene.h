/// The scene: circles and walls that rays may hit, sorted so that an agent checks only those near it.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "physics/grid.h"
#include "world/obstacle_sight.h"
#include "world/world.h"

namespace hedon {

/// Collects the circles that rays may hit and sorts them by cell. Within a cell, living agents come first, in their
/// order, then foods, then foods just eaten if they are seen.
template <class Crew>
HEDON_FN void gather_scene(const Crew& crew, World& world) {
  RayScene& scene = world.scene;
  const WorldState& state = world.state;
  const WorldShape& shape = *world.shape;
  const RayGrid& grid = shape.scene;
  const BodyState& body = state.physics.bodies;
  const StaticCircles& food = state.physics.circles;
  const int32_t foods = world.head().living_count, eaten = foods + shape.foods;  // where these begin
  const auto place_of = [&](int32_t circle) {
    if (circle < foods) return Vec2{body.x[state.living[circle]], body.y[state.living[circle]]};
    if (circle < eaten) return Vec2{food.x[circle - foods], food.y[circle - foods]};
    return Vec2{state.eaten_food[circle - eaten].x, state.eaten_food[circle - eaten].y};
  };
  const auto cell_of = [&](int32_t circle) {
    if (circle >= foods && circle < eaten && !food.present[circle - foods]) return -1;
    const Vec2 place = place_of(circle);
    const int32_t column = cell_along(place.x, grid.inverse_cell, grid.columns);
    return cell_along(place.y, grid.inverse_cell, grid.rows) * grid.columns + column;
  };
  const auto put = [&](int32_t circle, int32_t at, int32_t) {
    const Vec2 place = place_of(circle);
    scene.x[at] = place.x;
    scene.y[at] = place.y;
    if (scene.slot.count > 0) scene.slot[at] = circle < foods ? state.living[circle] : -1;
    if (circle < foods) {
      const int32_t slot = state.living[circle], s = shape.species_of(slot);
      scene.radius[at] = shape.own ? state.own[slot].body.radius : shape.of[s].body.radius;
      scene.type[at] = static_cast<float>(s);
      scene.own[slot] = at;
    } else {
      const int32_t kind =
          circle < eaten ? shape.bodies.circle_class(circle - foods) : state.eaten_food[circle - eaten].kind;
      scene.radius[at] = world.config->world.food_radius;
      scene.type[at] = static_cast<float>(shape.food_type(kind));
    }
  };
  crew.sort(eaten + world.head().eaten_food_count, grid.columns * grid.rows, scene.start.data, scene.cell.data, cell_of,
            put);
}

/// Calls f(circle) for the circles in the cells that a square around a point touches: a superset of the circles within
/// `reach` [u].
template <class F>
HEDON_FN void for_each_circle_in(const World& world, Vec2 center, float reach, F&& f) {
  const RayGrid& grid = world.shape->scene;
  const int32_t first_column = cell_along(center.x - reach, grid.inverse_cell, grid.columns);
  const int32_t last_column = cell_along(center.x + reach, grid.inverse_cell, grid.columns);
  const int32_t first_row = cell_along(center.y - reach, grid.inverse_cell, grid.rows);
  const int32_t last_row = cell_along(center.y + reach, grid.inverse_cell, grid.rows);
  for (int32_t row = first_row; row <= last_row; ++row) {
    const int32_t* start = world.scene.start.data + int64_t{row} * grid.columns;
    for (int32_t i = start[first_column]; i < start[last_column + 1]; ++i) f(i);
  }
}

/// The scene in the form that the kernels use.
HEDON_FN RayTargets ray_targets(const World& world) {
  const RayScene& scene = world.scene;
  return {scene.x.data,
          scene.y.data,
          scene.radius.data,
          scene.type.data,
          scene.wall_ax.data,
          scene.wall_ay.data,
          scene.wall_bx.data,
          scene.wall_by.data,
          misreads_obstacles(world) ? world.shape->first_obstacle : world.shape->walls,
          world.shape->first_obstacle,
          static_cast<float>(world.shape->wall_type())};
}

/// Empty lists of candidates circles in the memory of one member of the team.
HEDON_FN RayCandidates no_candidates(const World& world, int rank) {
  const int64_t room = int64_t{world.shape->circles} + 16;
  RayCandidates candidates{};
  for (int32_t a = 0; a < RAY_ARCS; ++a)
    candidates.circle[a] = world.scene.candidates.data + (rank * RAY_ARCS + a) * room;
  return candidates;
}

/// A rectangle around the agent, in its own frame [u].
struct Box {
  float low_x, low_y, high_x, high_y;
};

/// The rectangle around the fan between two directions, less than half a turn apart, up to `reach`; or around the whole
/// circle if the fan is not convex.
HEDON_FN Box box_of(Vec2 right, Vec2 left, float reach, bool convex) {
  if (!convex) return {-reach, -reach, reach, reach};
  const auto least = [](float a, float b) { return a < b ? a : b; };
  const auto most = [](float a, float b) { return a > b ? a : b; };
  // The corners of the fan; an axis that points into the fan reaches further.
  Box box{least(0.0f, least(right.x, left.x)), least(0.0f, least(right.y, left.y)), most(0.0f, most(right.x, left.x)),
          most(0.0f, most(right.y, left.y))};
  const auto inside = [&](Vec2 axis) { return cross(right, axis) >= 0.0f && cross(axis, left) >= 0.0f; };
  if (inside({-1.0f, 0.0f})) box.low_x = -1.0f;
  if (inside({0.0f, -1.0f})) box.low_y = -1.0f;
  if (inside({1.0f, 0.0f})) box.high_x = 1.0f;
  if (inside({0.0f, 1.0f})) box.high_y = 1.0f;
  return {box.low_x * reach, box.low_y * reach, box.high_x * reach, box.high_y * reach};
}

/// Finds the circles in the cells that a rectangle around the fan touches, grown by the radius of the largest circle.
/// kernel   an object with a `cull_circles`
template <class Culler>
HEDON_FN void find_circles(const Culler& kernel, const World& world, const RayTargets& targets, const RayFan& fan,
                           const Box& box, RayCandidates& candidates) {
  const RayGrid& grid = world.shape->scene;
  const float largest = world.shape->bodies.max_radius();
  const float margin = largest > world.config->world.food_radius ? largest : world.config->world.food_radius;
  const int32_t first_column = cell_along(fan.x + box.low_x - margin, grid.inverse_cell, grid.columns);
  const int32_t last_column = cell_along(fan.x + box.high_x + margin, grid.inverse_cell, grid.columns);
  const int32_t first_row = cell_along(fan.y + box.low_y - margin, grid.inverse_cell, grid.rows);
  const int32_t last_row = cell_along(fan.y + box.high_y + margin, grid.inverse_cell, grid.rows);
  for (int32_t row = first_row; row <= last_row; ++row) {
    const int32_t* start = world.scene.start.data + int64_t{row} * grid.columns;
    kernel.cull_circles(targets, fan, start[first_column], start[last_column + 1], candidates);
  }
}

}  // namespace hedon
