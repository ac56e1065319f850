/// Every setting that the engine gets, as `src/hedon/config` declares it, with its meaning, unit, range and source.
/// This file is written by `uv run python -m hedon.config.header > engine/config/schema.h`. Do not edit it.
// clang-format off
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"
#include "base/vec2.h"
#include "config/setting.h"

namespace hedon {

inline constexpr int MAX_SPECIES = 4;
inline constexpr int MAX_FOOD_KINDS = 8;
inline constexpr int MAX_OBSTACLES = 256;
inline constexpr int MAX_RAYS = 32;
inline constexpr int MAX_TOUCH_BITS = 128;
inline constexpr int MAX_STORES = 8;
inline constexpr int MAX_QUERIES = 4;
inline constexpr int MAX_OBSERVED = 15;
inline constexpr int MAX_GENES = 64;
inline constexpr float MAX_FORCE = 1000000.0;
inline constexpr float MAX_DISTANCE = 1000000.0;
inline constexpr float MAX_FACTOR = 1000.0;

struct GeneConfig {
  float initial_mean;
  float initial_sd;
  HEDON_FIELDS(GeneConfig, initial_mean, initial_sd)
  static constexpr Limit LIMITS[] = {Limit::from(-1000, 1000), Limit::from(0, 1000)};
};

HEDON_ENUM(MutationLaw, cauchy, student_t, normal, uniform)
struct MutationConfig {
  MutationLaw law;
  float scale;
  float df;
  float probability;
  float limit;
  HEDON_FIELDS(MutationConfig, law, scale, df, probability, limit)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(0, 1000), Limit::over(0, 1000), Limit::from(0, 1),
      Limit::over(0, 1000)};
};

struct ArenaConfig {
  float width;  ///< [u]
  float height;  ///< [u]
  HEDON_FIELDS(ArenaConfig, width, height)
  static constexpr Limit LIMITS[] = {Limit::over(0, 100000), Limit::over(0, 100000)};
};

HEDON_ENUM(PhysicsSolver, sequential, jacobi)
struct PhysicsConfig {
  float dt;  ///< [s]
  int32_t substeps;
  PhysicsSolver solver;
  int32_t velocity_passes;
  int32_t position_passes;
  float linear_damping;  ///< [1/s]
  float angular_damping;  ///< [1/s]
  float max_speed;  ///< [u/s]
  float max_angular_speed;  ///< [rad/s]
  float friction;
  float restitution;
  float restitution_threshold;  ///< [u/s]
  float correction_rate;
  float slop;  ///< [u]
  float max_correction;  ///< [u]
  float neighbor_skin;  ///< [u]
  HEDON_FIELDS(PhysicsConfig, dt, substeps, solver, velocity_passes, position_passes, linear_damping, angular_damping,
      max_speed, max_angular_speed, friction, restitution, restitution_threshold, correction_rate, slop, max_correction,
      neighbor_skin)
  static constexpr Limit LIMITS[] = {Limit::over(0, 1), Limit::from(1, 100), Limit(), Limit::from(1, 100),
      Limit::from(0, 100), Limit::from(0, 100), Limit::from(0, 100), Limit::over(0, 10000), Limit::over(0, 1000),
      Limit::from(0, 10), Limit::from(0, 1), Limit::from(0, 10000), Limit::from(0, 1), Limit::from(0, 10),
      Limit::over(0, 100), Limit::over(0, 1000)};
};

HEDON_ENUM(ScheduleForm, steps, linear)
struct ScheduleConfig {
  FixedList<SchedulePoint, 16> points;  ///< [step]
  ScheduleForm form;
  int32_t period;  ///< [step]
  HEDON_FIELDS(ScheduleConfig, points, form, period)
  static constexpr Limit LIMITS[] = {Limit::from(0, 1000000000), Limit(), Limit::from(0, 1000000000)};
};

struct ObstacleSchedule {
  ScheduleConfig harmful;
  HEDON_FIELDS(ObstacleSchedule, harmful)
  static constexpr Limit LIMITS[] = {Limit::from(0, 1)};
};

HEDON_ENUM(ObstacleSight, correct, released)
struct ObstacleConfig {
  int32_t count;
  int32_t corners;
  float min_side;  ///< [u]
  float max_side;  ///< [u]
  float min_angle;  ///< [rad]
  float max_angle;  ///< [rad]
  float cell;  ///< [u]
  ObstacleSight sight;
  float friction;
  float restitution;
  float damage;  ///< [energy/step]
  ObstacleSchedule schedule;
  HEDON_FIELDS(ObstacleConfig, count, corners, min_side, max_side, min_angle, max_angle, cell, sight, friction,
      restitution, damage, schedule)
  static constexpr Limit LIMITS[] = {Limit::from(0, 256), Limit::from(3, 8), Limit::over(0, 10000), Limit::over(0,
      10000), Limit::from(0, 6.2832), Limit::from(0, 6.2832), Limit::from(0, 100000), Limit(), Limit::from(0, 100),
      Limit::from(0, 1), Limit::from(0, 10000), Limit()};
};

HEDON_ENUM(PlacementForm, uniform, gaussian, switching, mixture, rectangle)
struct PlacementConfig {
  PlacementForm form;
  FixedList<Vec2, 16> centers;  ///< [u]
  Vec2 sd;  ///< [u]
  int32_t switch_after;  ///< [food]
  Vec2 drift;  ///< [u/step]
  float spacing;  ///< [u]
  HEDON_FIELDS(PlacementConfig, form, centers, sd, switch_after, drift, spacing)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(0, 100000), Limit::from(0, 100000), Limit::from(1,
      1000000000), Limit::from(-10000, 10000), Limit::from(0, 10000)};
};

struct FoodSchedule {
  ScheduleConfig growth_rate;
  ScheduleConfig capacity;
  HEDON_FIELDS(FoodSchedule, growth_rate, capacity)
  static constexpr Limit LIMITS[] = {Limit::from(0, 1000), Limit::from(0, 1)};
};

struct FoodConfig {
  float growth_rate;  ///< [food/step]
  int32_t capacity;  ///< [food]
  int32_t initial_count;  ///< [food]
  int32_t candidates;
  PlacementConfig placement;
  FoodSchedule schedule;
  HEDON_FIELDS(FoodConfig, growth_rate, capacity, initial_count, candidates, placement, schedule)
  static constexpr Limit LIMITS[] = {Limit::from(0, 1000), Limit::from(0, 100000), Limit::from(0, 100000),
      Limit::from(1, 10000), Limit(), Limit()};
};

HEDON_ENUM(WorldEatenFood, gone, seen)
HEDON_ENUM(WorldMouths, nearest, all)
HEDON_ENUM(WorldPreySharing, one, each)
HEDON_ENUM(WorldPreyAtMouth, nearest, all)
HEDON_ENUM(WorldPreyEnergy, after_costs, before_step)
HEDON_ENUM(WorldBirthOrder, before_deaths, after_deaths)
HEDON_ENUM(WorldInheritance, at_birth, at_window_end)
HEDON_ENUM(WorldParents, all, resident_slots)
HEDON_ENUM(WorldChildHeading, own, shared)
HEDON_ENUM(WorldMutationNoise, independent, tabulated)
struct WorldConfig {
  float food_radius;  ///< [u]
  WorldEatenFood eaten_food;
  WorldMouths mouths;
  WorldPreySharing prey_sharing;
  WorldPreyAtMouth prey_at_mouth;
  WorldPreyEnergy prey_energy;
  WorldBirthOrder birth_order;
  WorldInheritance inheritance;
  WorldParents parents;
  WorldChildHeading child_heading;
  WorldMutationNoise mutation_noise;
  int32_t rollout_steps;  ///< [step]
  HEDON_FIELDS(WorldConfig, food_radius, eaten_food, mouths, prey_sharing, prey_at_mouth, prey_energy, birth_order,
      inheritance, parents, child_heading, mutation_noise, rollout_steps)
  static constexpr Limit LIMITS[] = {Limit::over(0, 1000), Limit(), Limit(), Limit(), Limit(), Limit(), Limit(),
      Limit(), Limit(), Limit(), Limit(), Limit::from(1, 65536)};
};

struct BodyConfig {
  float radius;  ///< [u]
  float density;  ///< [mass/u²]
  HEDON_FIELDS(BodyConfig, radius, density)
  static constexpr Limit LIMITS[] = {Limit::over(0, 1000), Limit::over(0, 1000)};
};

struct MotorConfig {
  float angle;  ///< [degree]
  HEDON_FIELDS(MotorConfig, angle)
  static constexpr Limit LIMITS[] = {Limit::from(0, 180)};
};

HEDON_ENUM(SensorRayInside, hit, behind)
struct SensorConfig {
  int32_t ray_count;
  float ray_spread;  ///< [degree]
  float ray_length;  ///< [u]
  float smell_decay;  ///< [1/u]
  int32_t noses;
  float nose_angle;  ///< [degree]
  int32_t touch_sectors;
  float mouth_spread;  ///< [degree]
  float mouth_center;  ///< [degree]
  SensorRayInside ray_inside;
  HEDON_FIELDS(SensorConfig, ray_count, ray_spread, ray_length, smell_decay, noses, nose_angle, touch_sectors,
      mouth_spread, mouth_center, ray_inside)
  static constexpr Limit LIMITS[] = {Limit::from(1, 32), Limit::from(0, 180), Limit::over(0, 100000), Limit::from(0.001,
      10), Limit::from(1, 2), Limit::from(0, 180), Limit::from(1, 32), Limit::over(0, 180), Limit::from(-180, 180),
      Limit()};
};

struct PopulationConfig {
  int32_t capacity;  ///< [agent]
  int32_t initial_count;  ///< [agent]
  float heading_range;  ///< [rad]
  HEDON_FIELDS(PopulationConfig, capacity, initial_count, heading_range)
  static constexpr Limit LIMITS[] = {Limit::from(1, 100000), Limit::from(0, 100000), Limit::from(0, 6.2832)};
};

struct DietConfig {
  int32_t digestion_steps;  ///< [step]
  HEDON_FIELDS(DietConfig, digestion_steps)
  static constexpr Limit LIMITS[] = {Limit::from(0, 1000000)};
};

HEDON_ENUM(StoreAtZero, floor, death)
struct StoreConfig {
  float initial;  ///< [amount]
  float capacity;  ///< [amount]
  float basic_cost;  ///< [amount/step]
  float action_cost;  ///< [amount/(step·force)]
  float decay;  ///< [1/step]
  float child_share;
  StoreAtZero at_zero;
  float hazard_weight;
  float birth_weight;
  float motor_threshold;  ///< [amount]
  HEDON_FIELDS(StoreConfig, initial, capacity, basic_cost, action_cost, decay, child_share, at_zero, hazard_weight,
      birth_weight, motor_threshold)
  static constexpr Limit LIMITS[] = {Limit::from(0, 1000000), Limit::over(0, 1000000), Limit::from(0, 10000),
      Limit::from(0, 10000), Limit::from(0, 1), Limit::from(0, 1), Limit(), Limit::from(0, 10000), Limit::from(-10000,
      10000), Limit::from(0, 1000)};
};

struct HazardSchedule {
  ScheduleConfig scale;
  HEDON_FIELDS(HazardSchedule, scale)
  static constexpr Limit LIMITS[] = {Limit::from(0, 1000)};
};

HEDON_ENUM(HazardForm, age_energy, gompertz, constant)
struct HazardConfig {
  HazardForm form;
  float kappa;  ///< [1/step]
  float alpha_energy;
  float beta_energy;  ///< [1/energy]
  float alpha_age;  ///< [1/step]
  float beta_age;  ///< [1/step]
  HazardSchedule schedule;
  HEDON_FIELDS(HazardConfig, form, kappa, alpha_energy, beta_energy, alpha_age, beta_age, schedule)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(0, 1), Limit::from(0, 1000000), Limit::from(0, 100),
      Limit::from(0, 1), Limit::from(0, 1), Limit()};
};

HEDON_ENUM(BirthForm, logistic, threshold)
HEDON_ENUM(BirthNetwork, none, initial, learned)
HEDON_ENUM(BirthMating, none, pairs)
struct BirthConfig {
  BirthForm form;
  float kappa;  ///< [1/step]
  float beta;  ///< [1/energy]
  float logit_offset;
  int32_t attempts;
  BirthNetwork network;
  float network_noise;
  BirthMating mating;
  int32_t mating_window;  ///< [step]
  float mating_range;  ///< [u]
  HEDON_FIELDS(BirthConfig, form, kappa, beta, logit_offset, attempts, network, network_noise, mating, mating_window,
      mating_range)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(0, 1), Limit::from(0, 100), Limit::from(-1000, 1000),
      Limit::from(1, 1000), Limit(), Limit::from(0, 10), Limit(), Limit::from(0, 1000000), Limit::from(0, 10000)};
};

HEDON_ENUM(RewardFamily, linear, sinh, scaled, above, below, between, around)
struct RewardConfig {
  RewardFamily family;
  float threshold;  ///< [that of the gate]
  float threshold_width;  ///< [that of the gate]
  float drive_exponent;
  float drive_root;
  int32_t memory;
  HEDON_FIELDS(RewardConfig, family, threshold, threshold_width, drive_exponent, drive_root, memory)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(-1000000, 1000000), Limit::over(0, 1000000), Limit::from(1,
      8), Limit::from(1, 8), Limit::from(0, 16)};
};

HEDON_ENUM(LearningPolicy, ppo, random, idle, external, fixed)
HEDON_ENUM(LearningCriticTarget, per_state, batch_mean)
HEDON_ENUM(LearningRewardScaling, none, window)
HEDON_ENUM(LearningAdvantageNormalization, none, window)
HEDON_ENUM(LearningActingWeights, float32, bfloat16)
struct LearningConfig {
  LearningPolicy policy;
  int32_t minibatch_size;  ///< [step]
  int32_t update_epochs;
  float gamma;  ///< [1/step]
  float gae_lambda;  ///< [1/step]
  float clip_coef;
  float learning_rate;
  float adam_beta1;
  float adam_beta2;
  float adam_epsilon;
  float value_coef;
  float entropy_coef;
  LearningCriticTarget critic_target;
  LearningRewardScaling reward_scaling;
  LearningAdvantageNormalization advantage_normalization;
  LearningActingWeights acting_weights;
  HEDON_FIELDS(LearningConfig, policy, minibatch_size, update_epochs, gamma, gae_lambda, clip_coef, learning_rate,
      adam_beta1, adam_beta2, adam_epsilon, value_coef, entropy_coef, critic_target, reward_scaling,
      advantage_normalization, acting_weights)
  static constexpr Limit LIMITS[] = {Limit(), Limit::from(1, 65536), Limit::from(0, 1000), Limit::from(0, 1),
      Limit::from(0, 1), Limit::over(0, 10), Limit::from(0, 1), Limit::under(0, 1), Limit::under(0, 1), Limit::over(0,
      1), Limit::from(0, 1000), Limit::from(0, 1000), Limit(), Limit(), Limit(), Limit()};
};

struct SpeciesConfig {
  BodyConfig body;
  MotorConfig motor;
  SensorConfig sensor;
  PopulationConfig population;
  DietConfig diet;
  StoreConfig energy;
  FixedList<StoreConfig, 7> store;
  HazardConfig hazard;
  BirthConfig birth;
  RewardConfig reward;
  LearningConfig learning;
  HEDON_FIELDS(SpeciesConfig, body, motor, sensor, population, diet, energy, store, hazard, birth, reward, learning)
  static constexpr Limit LIMITS[] = {Limit(), Limit(), Limit(), Limit(), Limit(), Limit(), Limit(), Limit(), Limit(),
      Limit(), Limit()};
};

struct Settings {
  ArenaConfig arena;
  PhysicsConfig physics;
  ObstacleConfig obstacle;
  FixedList<FoodConfig, 8> food;
  WorldConfig world;
  FixedList<SpeciesConfig, 4> species;
  HEDON_FIELDS(Settings, arena, physics, obstacle, food, world, species)
  static constexpr Limit LIMITS[] = {Limit(), Limit(), Limit(), Limit(), Limit(), Limit()};
};

HEDON_ENUM(GenomeLearning, learning_rate, gamma, entropy_coef, action_sd)
HEDON_ENUM(GenomeFamily, threshold, threshold_width)
HEDON_ENUM(RuleUse, reward, hazard, birth)
HEDON_ENUM(ChannelSource, velocity, angle, heading, angular_velocity, store, store_before, store_change, meals, damage,
      see_mean, see_max, nearness, smell, smell_mean, contacts, touched, neighbor_count, neighbor_kin,
      neighbor_distance, neighbor_bearing, neighbor_meals, effort, force, force_norm, moved, position, age, births,
      waits, drive_reduction, season, step, alive, one, last)
HEDON_ENUM(ChannelOf, one, two, stores, meals, sees, smells, noses, touches, season, queries, companies, harm, mates,
      drive, last)
inline constexpr ChannelOf CHANNEL_OF[] = {ChannelOf::two, ChannelOf::one, ChannelOf::two, ChannelOf::one,
      ChannelOf::stores, ChannelOf::stores, ChannelOf::stores, ChannelOf::meals, ChannelOf::harm, ChannelOf::sees,
      ChannelOf::sees, ChannelOf::one, ChannelOf::noses, ChannelOf::smells, ChannelOf::touches, ChannelOf::one,
      ChannelOf::queries, ChannelOf::companies, ChannelOf::queries, ChannelOf::queries, ChannelOf::companies,
      ChannelOf::one, ChannelOf::two, ChannelOf::one, ChannelOf::one, ChannelOf::two, ChannelOf::one, ChannelOf::one,
      ChannelOf::mates, ChannelOf::drive, ChannelOf::season, ChannelOf::one, ChannelOf::one, ChannelOf::one,
      ChannelOf::last};

}  // namespace hedon
