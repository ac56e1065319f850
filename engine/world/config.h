/// Settings of a world. Meaning, unit, range and source of each are in `src/hedon/config/`.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"
#include "base/vec2.h"
#include "evolution/config.h"
#include "learning/config.h"
#include "physics/config.h"

namespace hedon {

inline constexpr int MAX_FOOD_KINDS = 8;
inline constexpr int MAX_FOOD_CENTERS = 16;
inline constexpr int MAX_RAYS = 32;
inline constexpr int MAX_TYPES = MAX_FOOD_KINDS + 2;  ///< agent, each food kind, wall

struct ArenaConfig {
  float width;
  float height;

  HEDON_FIELDS(ArenaConfig, width, height)
};

struct BodyConfig {
  float radius;
  float density;
  float food_radius;

  HEDON_FIELDS(BodyConfig, radius, density, food_radius)
};

struct MotorConfig {
  float min_force;
  float max_force;
  float angle;  ///< between each motor and the heading [degree]

  HEDON_FIELDS(MotorConfig, min_force, max_force, angle)
};

enum class ObservationScaling : int32_t { raw, unit };
inline constexpr const char* OBSERVATION_SCALING_NAMES[] = {"raw", "unit"};

struct SensorConfig {
  int32_t ray_count;
  float ray_spread;  ///< between the heading and the outermost ray on each side [degree]
  float ray_length;
  int32_t touch_sectors;
  float mouth_spread;  ///< between the heading and each end of the mouth [degree]
  ObservationScaling scaling;

  HEDON_FIELDS(SensorConfig, ray_count, ray_spread, ray_length, touch_sectors, mouth_spread, scaling)
};

struct PopulationConfig {
  int32_t capacity;
  int32_t initial_count;

  HEDON_FIELDS(PopulationConfig, capacity, initial_count)
};

enum class PlacementForm : int32_t { uniform, gaussian, switching };
inline constexpr const char* PLACEMENT_FORM_NAMES[] = {"uniform", "gaussian", "switching"};

struct PlacementConfig {
  PlacementForm form;
  FixedList<Vec2, MAX_FOOD_CENTERS> centers;
  Vec2 sd;
  int32_t switch_after;

  HEDON_FIELDS(PlacementConfig, form, centers, sd, switch_after)
};

struct FoodConfig {
  float energy;
  float growth_rate;
  int32_t capacity;
  int32_t initial_count;
  int32_t candidates;
  PlacementConfig placement;

  HEDON_FIELDS(FoodConfig, energy, growth_rate, capacity, initial_count, candidates, placement)
};

enum class Starvation : int32_t { floor, death };
inline constexpr const char* STARVATION_NAMES[] = {"floor", "death"};

struct EnergyConfig {
  float initial;
  float capacity;
  float basic_cost;
  float action_cost;
  float birth_share;
  Starvation starvation;

  HEDON_FIELDS(EnergyConfig, initial, capacity, basic_cost, action_cost, birth_share, starvation)
};

struct HazardConfig {
  float kappa;
  float alpha_energy;
  float beta_energy;
  float alpha_age;
  float beta_age;

  HEDON_FIELDS(HazardConfig, kappa, alpha_energy, beta_energy, alpha_age, beta_age)
};

struct BirthConfig {
  float kappa;
  float beta;
  int32_t attempts;
  Vec2 distance_sd;

  HEDON_FIELDS(BirthConfig, kappa, beta, attempts, distance_sd)
};

struct WorldConfig {
  ArenaConfig arena;
  PhysicsConfig physics;
  BodyConfig body;
  MotorConfig motor;
  SensorConfig sensor;
  PopulationConfig population;
  FixedList<FoodConfig, MAX_FOOD_KINDS> food;
  EnergyConfig energy;
  HazardConfig hazard;
  BirthConfig birth;
  GenomeConfig genome;
  RewardConfig reward;
  LearningConfig learning;

  HEDON_FIELDS(WorldConfig, arena, physics, body, motor, sensor, population, food, energy, hazard, birth, genome,
               reward, learning)
};

}  // namespace hedon
