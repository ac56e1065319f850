/// Sizes and constants that follow from a config: computed once, never changed.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/math.h"
#include "base/vec2.h"
#include "evolution/genome.h"
#include "learning/network.h"
#include "learning/observation.h"
#include "physics/body.h"
#include "world/config.h"

namespace hedon {

/// Types that senses distinguish: agents, each food kind, walls.
inline constexpr int AGENT_TYPE = 0;

/// The grid for sorting the circles that rays may hit.
struct RayGrid {
  float inverse_cell;  ///< cells per length [1/u]
  int32_t columns;
  int32_t rows;
};

/// Cells are a third as wide as a ray is long, so that the cells around a fan are few and hold few other circles. They
/// are wider if an arena is so empty that there would be more cells than circles.
HEDON_FN RayGrid make_ray_grid(const WorldConfig& config, int32_t circles) {
  const float width = config.arena.width, height = config.arena.height;
  const float reach = (config.body.radius + config.sensor.ray_length) / 3.0f;
  const float even = sqrtf(width * height / static_cast<float>(circles));
  const float inverse_cell = 1.0f / (reach > even ? reach : even);
  return {inverse_cell, static_cast<int32_t>(width * inverse_cell) + 1,
          static_cast<int32_t>(height * inverse_cell) + 1};
}

struct WorldShape {
  int32_t capacity;  ///< most agents alive at a time
  int32_t kinds;     ///< food kinds
  int32_t foods;     ///< most foods present at a time, all kinds
  int32_t walls;
  int32_t outer_walls;  ///< the first walls, a closed convex polygon
  int32_t circles;      ///< most circles that rays may hit: agents, foods, and foods just eaten if they are seen
  int32_t events;       ///< deaths that can wait for the reader
  int32_t newborns;     ///< births of a window that can wait for their genomes
  int32_t steps;        ///< of a rollout
  GenomeShape genome;
  NetworkShape network;
  int32_t food_offset[MAX_FOOD_KINDS + 1];  ///< kind k owns food slots [offset[k], offset[k + 1])
  RayGrid scene;

  HEDON_FN int32_t wall_type() const { return 1 + kinds; }
  HEDON_FN int32_t types() const { return kinds + 2; }
};

/// Deaths per slot that can wait for the reader. The host loop reads a few times per second, about every thousand
/// steps, in which about one agent in ten dies.
inline constexpr int EVENTS_PER_SLOT = 16;

HEDON_FN WorldShape make_shape(const WorldConfig& config, int32_t walls, int32_t outer_walls) {
  WorldShape shape{};
  shape.capacity = config.population.capacity;
  shape.kinds = config.food.count;
  shape.walls = walls;
  shape.outer_walls = outer_walls;
  shape.events = EVENTS_PER_SLOT * shape.capacity;
  shape.steps = config.learning.rollout_steps;
  for (int32_t k = 0; k < shape.kinds; ++k) shape.food_offset[k + 1] = shape.food_offset[k] + config.food[k].capacity;
  shape.foods = shape.food_offset[shape.kinds];
  shape.circles = shape.capacity + shape.foods + (config.sensor.eaten_food == EatenFood::seen ? shape.foods : 0);
  shape.newborns = config.birth.inheritance == Inheritance::at_window_end ? shape.events : 0;
  shape.scene = make_ray_grid(config, shape.capacity + shape.foods);
  shape.genome = {shape.kinds, config.genome.neutral_count};
  const int32_t dense = config.sensor.scaling == ObservationScaling::raw ? 5 : 6;
  shape.network = {{config.sensor.ray_count, shape.types(), shape.types() * config.sensor.touch_sectors, dense}};
  return shape;
}

/// Constants of all steps, computed once.
struct WorldConstants {
  BodyShape body;
  float motor_arm;                       ///< lever of each motor about the center [u]
  float max_force;                       ///< largest norm of the two forces: the norm of (f_max, f_max)
  float mouth_cosine;                    ///< cosine of the mouth's half angle
  alignas(64) float ray_sine[MAX_RAYS];  ///< of each ray's angle to the heading; past the last ray the last repeats
  alignas(64) float ray_cosine[MAX_RAYS];
  bool fan_convex;        ///< the fan spans less than half a turn
  bool arc_convex;        ///< 16 neighboring rays do
  float sector_sine[65];  ///< of each touch sector's first edge, counter-clockwise of the heading
  float sector_cosine[65];
};

HEDON_FN WorldConstants make_constants(const WorldConfig& config) {
  const double degree = PI / 180.0;
  WorldConstants c{};
  c.body = make_disc(config.body.radius, config.body.density, config.body.food_radius);
  double sine, cosine;
  sincos_double(config.motor.angle * degree, &sine, &cosine);
  c.motor_arm = static_cast<float>(config.body.radius * sine);
  c.max_force = config.motor.max_force * sqrtf(2.0f);
  sincos_double(config.sensor.mouth_spread * degree, &sine, &cosine);
  // A mouth on all sides: rounding must not leave a gap directly behind.
  c.mouth_cosine = config.sensor.mouth_spread < 180.0f ? static_cast<float>(cosine) : -2.0f;
  const int32_t rays = config.sensor.ray_count;
  const double spread = config.sensor.ray_spread * degree;
  for (int32_t r = 0; r < MAX_RAYS; ++r) {
    const int32_t ray = r < rays ? r : rays - 1;
    const double angle = rays == 1 ? 0.0 : -spread + 2.0 * spread * ray / (rays - 1);
    sincos_double(angle, &sine, &cosine);
    c.ray_sine[r] = static_cast<float>(sine);
    c.ray_cosine[r] = static_cast<float>(cosine);
  }
  c.fan_convex = config.sensor.ray_spread < 90.0f;
  c.arc_convex = c.fan_convex || (rays > 16 && config.sensor.ray_spread * 15.0f < 90.0f * static_cast<float>(rays - 1));
  for (int32_t s = 0; s <= config.sensor.touch_sectors; ++s) {
    sincos_double(2.0 * PI * s / config.sensor.touch_sectors, &sine, &cosine);
    c.sector_sine[s] = static_cast<float>(sine);
    c.sector_cosine[s] = static_cast<float>(cosine);
  }
  return c;
}

/// Heading 0 points along +y; positive is counter-clockwise.
HEDON_FN Vec2 heading(float angle) {
  float sine, cosine;
  sincos_float(angle, &sine, &cosine);
  return {-sine, cosine};
}

/// Direction of ray `r` of an agent with heading `forward`; past the last ray, the last one repeats.
HEDON_FN Vec2 ray_direction(const WorldConstants& constants, int32_t r, Vec2 forward) {
  return constants.ray_cosine[r] * forward + constants.ray_sine[r] * Vec2{-forward.y, forward.x};
}

}  // namespace hedon
