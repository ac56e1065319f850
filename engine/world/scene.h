/// The scene: circles and walls that rays may hit, sorted so that an agent checks only those near it.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "physics/grid.h"
#include "world/world.h"

namespace hedon {

/// Collects the circles that rays may hit and sorts them by cell; within a cell, the living come in their order, then
/// the foods, then those just eaten if they are seen. (A counting sort: its time is in proportion to the circles and
/// cells.)
HEDON_FN void gather_scene(World& world) {
  RayScene& scene = world.scene;
  const WorldState& state = world.state;
  const RayGrid& grid = world.shape->scene;
  const int32_t cells = grid.columns * grid.rows;
  for (int32_t cell = 0; cell <= cells; ++cell) scene.start[cell] = 0;
  const auto find_cell = [&](int32_t circle, float x, float y) {
    const int32_t column = cell_along(x, grid.inverse_cell, grid.columns);
    const int32_t cell = cell_along(y, grid.inverse_cell, grid.rows) * grid.columns + column;
    scene.cell[circle] = cell;
    ++scene.start[cell];
  };
  const int32_t living = world.head().living_count, capacity = world.shape->capacity;
  const BodyState& body = state.physics.bodies;
  const StaticCircles& food = state.physics.circles;
  for (int32_t i = 0; i < living; ++i) find_cell(i, body.x[state.living[i]], body.y[state.living[i]]);
  for (int32_t f = 0; f < world.shape->foods; ++f) {
    if (food.present[f]) find_cell(capacity + f, food.x[f], food.y[f]);
  }
  const int32_t ghosts = world.head().ghost_count, first_ghost = capacity + world.shape->foods;
  for (int32_t g = 0; g < ghosts; ++g) find_cell(first_ghost + g, state.ghost[g].x, state.ghost[g].y);

  int32_t sum = 0;
  for (int32_t cell = 0; cell < cells; ++cell) {
    sum += scene.start[cell];
    scene.start[cell] = sum;  // the end of the cell; inserting its circles, last one first, makes it the start
  }
  scene.start[cells] = sum;
  const auto put = [&](int32_t circle, float x, float y, float radius, int32_t type) {
    const int32_t at = --scene.start[scene.cell[circle]];
    scene.x[at] = x;
    scene.y[at] = y;
    scene.radius[at] = radius;
    scene.type[at] = static_cast<float>(type);
    return at;
  };
  for (int32_t g = ghosts - 1; g >= 0; --g) {
    const Ghost& ghost = state.ghost[g];
    put(first_ghost + g, ghost.x, ghost.y, world.config->food_radius, world.shape->food_type(ghost.kind));
  }
  for (int32_t k = world.shape->kinds - 1; k >= 0; --k) {
    for (int32_t f = world.shape->food_offset[k + 1] - 1; f >= world.shape->food_offset[k]; --f) {
      if (food.present[f])
        put(capacity + f, food.x[f], food.y[f], world.config->food_radius, world.shape->food_type(k));
    }
  }
  for (int32_t i = living - 1; i >= 0; --i) {
    const int32_t slot = state.living[i];
    const int32_t s = world.shape->species_of(slot);
    scene.own[slot] = put(i, body.x[slot], body.y[slot], world.shape->of[s].body.radius, s);
  }
}

/// The scene in the form for the kernels.
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
          world.shape->walls,
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
/// kernel   what has a `cull_circles`
template <class Culler>
HEDON_FN void find_circles(const Culler& kernel, const World& world, const RayTargets& targets, const RayFan& fan,
                           const Box& box, RayCandidates& candidates) {
  const RayGrid& grid = world.shape->scene;
  const float largest = world.shape->bodies.max_radius();
  const float margin = largest > world.config->food_radius ? largest : world.config->food_radius;
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
