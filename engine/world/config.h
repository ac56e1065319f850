/// Settings of a world. Meaning, unit, range and source of each are in `src/hedon/config/`.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/device.h"
#include "base/fields.h"
#include "base/vec2.h"
#include "evolution/config.h"
#include "learning/config.h"
#include "physics/body.h"
#include "physics/config.h"

namespace hedon {

inline constexpr int MAX_SPECIES = MAX_BODY_CLASSES;
inline constexpr int MAX_FOOD_KINDS = MAX_CIRCLE_CLASSES;
inline constexpr int MAX_FOOD_CENTERS = 16;
inline constexpr int MAX_OBSTACLES = 256;
inline constexpr int MAX_RAYS = 32;
inline constexpr int MAX_SMELLS = 12;                               ///< channels times noses
inline constexpr int MAX_TYPES = MAX_SPECIES + MAX_FOOD_KINDS + 2;  ///< each species, each food kind, wall, obstacle

struct ArenaConfig {
  float width;
  float height;

  HEDON_FIELDS(ArenaConfig, width, height)
};

struct BodyConfig {
  float radius;
  float density;

  HEDON_FIELDS(BodyConfig, radius, density)
};

struct MotorConfig {
  float min_force;
  float max_force;
  float angle;  ///< between each motor and the heading [degree]

  HEDON_FIELDS(MotorConfig, min_force, max_force, angle)
};

enum class ObservationScaling : int32_t { raw, unit };
inline constexpr const char* OBSERVATION_SCALING_NAMES[] = {"raw", "unit"};

/// What a ray reads whose start lies inside another body or beyond a wall.
enum class RayInside : int32_t { hit, behind };
inline constexpr const char* RAY_INSIDE_NAMES[] = {"hit", "behind"};

/// Whether rays meet food that was eaten in the step before.
enum class EatenFoodRule : int32_t { gone, seen };
inline constexpr const char* EATEN_FOOD_NAMES[] = {"gone", "seen"};

/// Which of several mouths that touch a food in the same step are fed.
enum class Mouths : int32_t { nearest, all };
inline constexpr const char* MOUTHS_NAMES[] = {"nearest", "all"};

/// Who gains by an agent that several others eat in the same step: one of them, by a draw, or each in full.
enum class PreySharing : int32_t { one, each };
inline constexpr const char* PREY_SHARING_NAMES[] = {"one", "each"};

struct SensorConfig {
  int32_t ray_count;
  float ray_spread;  ///< between the heading and the outermost ray on each side [degree]
  float ray_length;
  int32_t touch_sectors;
  float mouth_spread;  ///< between the heading and each end of the mouth [degree]
  ObservationScaling scaling;
  RayInside ray_inside;
  FixedList<int32_t, MAX_TYPES> sees;      ///< types that rays meet, by channel, ascending
  FixedList<int32_t, MAX_TYPES> collides;  ///< types that it collides with and feels by touch, by channel, ascending
  FixedList<int32_t, MAX_TYPES> smells;    ///< types that it smells, by channel, ascending
  float smell_decay;                       ///< by how much a smell falls with distance [1/u]
  int32_t noses;
  float nose_angle;  ///< between the heading and each of two noses [degree]

  HEDON_FIELDS(SensorConfig, ray_count, ray_spread, ray_length, touch_sectors, mouth_spread, scaling, ray_inside, sees,
               collides, smells, smell_decay, noses, nose_angle)
};

struct PopulationConfig {
  int32_t capacity;
  int32_t initial_count;
  float heading_range;  ///< founders head to a uniform angle from 0 to this [rad]

  HEDON_FIELDS(PopulationConfig, capacity, initial_count, heading_range)
};

enum class PlacementForm : int32_t {
  uniform,
  gaussian,   ///< around the one center
  switching,  ///< around one center after another
  mixture,    ///< around any of the centers, by a draw
  rectangle,  ///< uniform in a rectangle around the one center, whose half sides are `sd`
};
inline constexpr const char* PLACEMENT_FORM_NAMES[] = {"uniform", "gaussian", "switching", "mixture", "rectangle"};

struct PlacementConfig {
  PlacementForm form;
  FixedList<Vec2, MAX_FOOD_CENTERS> centers;
  Vec2 sd;
  int32_t switch_after;
  Vec2 drift;     ///< of all centers [u per step], which stay inside the arena
  float spacing;  ///< least distance between the centers of foods of the kind

  HEDON_FIELDS(PlacementConfig, form, centers, sd, switch_after, drift, spacing)
};

enum class ScheduleForm : int32_t { steps, linear };
inline constexpr const char* SCHEDULE_FORM_NAMES[] = {"steps", "linear"};

struct SchedulePoint {
  int32_t step;
  float factor;

  HEDON_FIELDS(SchedulePoint, step, factor)
};

inline constexpr int MAX_SCHEDULE_POINTS = 16;

/// A factor that follows time; without points it is 1.
struct ScheduleConfig {
  ScheduleForm form;
  int32_t period;                                        ///< steps after which it begins again; 0: never
  FixedList<SchedulePoint, MAX_SCHEDULE_POINTS> points;  ///< steps rise

  HEDON_FIELDS(ScheduleConfig, form, period, points)
};

struct FoodConfig {
  float energy;
  float nutrient;
  float toxin;
  float growth_rate;
  int32_t capacity;
  int32_t initial_count;
  int32_t candidates;
  PlacementConfig placement;
  ScheduleConfig growth_schedule;
  ScheduleConfig capacity_schedule;

  HEDON_FIELDS(FoodConfig, energy, nutrient, toxin, growth_rate, capacity, initial_count, candidates, placement,
               growth_schedule, capacity_schedule)
};

/// Regular polygons that never move, at places that are drawn for each world.
struct ObstacleConfig {
  int32_t count;
  int32_t corners;  ///< of each
  float min_side;   ///< sides are between these [u]
  float max_side;
  float friction;
  float restitution;
  float damage;             ///< energy that touching one costs per step
  ScheduleConfig schedule;  ///< of the share of them that do harm

  HEDON_FIELDS(ObstacleConfig, count, corners, min_side, max_side, friction, restitution, damage, schedule)
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

/// A second store beside energy, filled by some kinds of food; one that is empty raises the hazard.
struct NutrientConfig {
  int32_t present;  ///< 1 if the species has it
  int32_t observed;
  float initial;
  float capacity;
  float basic_cost;
  float action_cost;
  float hazard_share;  ///< of the hazard's part by energy, with this store in place of energy

  HEDON_FIELDS(NutrientConfig, present, observed, initial, capacity, basic_cost, action_cost, hazard_share)
};

/// What some kinds of food leave in an agent, and weakens its motors until it is gone.
struct ToxinConfig {
  int32_t present;  ///< 1 if the species has it
  int32_t observed;
  float decay;
  float threshold;

  HEDON_FIELDS(ToxinConfig, present, observed, decay, threshold)
};

struct HazardConfig {
  float kappa;
  float alpha_energy;
  float beta_energy;
  float alpha_age;
  float beta_age;
  int32_t rule;             ///< 1 if a function of the caller computes it, and not the formula
  ScheduleConfig schedule;  ///< of the whole hazard

  HEDON_FIELDS(HazardConfig, kappa, alpha_energy, beta_energy, alpha_age, beta_age, rule, schedule)
};

/// Which of the two comes first in a step.
enum class BirthOrder : int32_t { before_deaths, after_deaths };
inline constexpr const char* BIRTH_ORDER_NAMES[] = {"before_deaths", "after_deaths"};

/// When a newborn gets its network and its genome.
enum class Inheritance : int32_t { at_birth, at_window_end };
inline constexpr const char* INHERITANCE_NAMES[] = {"at_birth", "at_window_end"};

/// Who may have children: everyone, or only agents in slots that were taken when the window began.
enum class Parents : int32_t { all, resident_slots };
inline constexpr const char* PARENTS_NAMES[] = {"all", "resident_slots"};

/// Whether each child has a heading of its own, or the children of one step share one.
enum class ChildHeading : int32_t { own, shared };
inline constexpr const char* CHILD_HEADING_NAMES[] = {"own", "shared"};

/// What a child gets of its parent's network.
enum class ChildNetwork : int32_t {
  none,     ///< nothing: it gets a fresh one
  initial,  ///< what its parent was born with, with noise
  learned,  ///< what its parent has learned, with noise
};
inline constexpr const char* CHILD_NETWORK_NAMES[] = {"none", "initial", "learned"};

/// How many parents a child has.
enum class Mating : int32_t { none, pairs };
inline constexpr const char* MATING_NAMES[] = {"none", "pairs"};

struct BirthConfig {
  float kappa;
  float beta;
  float logit_offset;
  int32_t rule;  ///< 1 if a function of the caller computes the chance, and not the formula
  int32_t attempts;
  Vec2 distance_sd;
  ChildNetwork network;
  float network_noise;  ///< standard deviation of what is added to each parameter
  Mating mating;
  int32_t mating_window;  ///< steps for which an agent whose draw made it a parent waits for another
  float mating_range;     ///< between their surfaces [u]

  HEDON_FIELDS(BirthConfig, kappa, beta, logit_offset, rule, attempts, distance_sd, network, network_noise, mating,
               mating_window, mating_range)
};

/// What a species eats.
struct DietConfig {
  FixedList<float, MAX_FOOD_KINDS> food;  ///< factor on the energy of each kind; 0: it does not eat this kind
  FixedList<float, MAX_SPECIES> prey;     ///< share of the energy of each species that it gains; 0: it does not eat it
  int32_t digestion_steps;                ///< after eating an agent, for which it eats no other

  HEDON_FIELDS(DietConfig, food, prey, digestion_steps)
};

/// Everything that makes a kind of agent. Types are numbered: the species, the food kinds, walls, then obstacles.
struct SpeciesConfig {
  BodyConfig body;
  MotorConfig motor;
  SensorConfig sensor;
  PopulationConfig population;
  DietConfig diet;
  EnergyConfig energy;
  NutrientConfig nutrient;
  ToxinConfig toxin;
  HazardConfig hazard;
  BirthConfig birth;
  GenomeConfig genome;
  RewardConfig reward;
  LearningConfig learning;

  HEDON_FIELDS(SpeciesConfig, body, motor, sensor, population, diet, energy, nutrient, toxin, hazard, birth, genome,
               reward, learning)
};

/// What a rule of the caller decides.
enum class RuleUse : int32_t { reward, hazard, birth };
inline constexpr const char* RULE_USE_NAMES[] = {"reward", "hazard", "birth"};
inline constexpr int RULE_USES = 3;

/// Whether a rule of the caller decides this for a species.
HEDON_FN bool has_rule(const SpeciesConfig& species, RuleUse use) {
  switch (use) {
    case RuleUse::reward:
      return species.reward.rule != 0;
    case RuleUse::hazard:
      return species.hazard.rule != 0;
    case RuleUse::birth:
      return species.birth.rule != 0;
  }
  return false;
}

HEDON_FN bool has_rule(const SpeciesConfig& species) {
  return has_rule(species, RuleUse::reward) || has_rule(species, RuleUse::hazard) || has_rule(species, RuleUse::birth);
}

/// Rules that all species of a world share.
struct RuleConfig {
  EatenFoodRule eaten_food;
  Mouths mouths;
  PreySharing prey_sharing;
  BirthOrder birth_order;
  Inheritance inheritance;
  Parents parents;
  ChildHeading child_heading;

  HEDON_FIELDS(RuleConfig, eaten_food, mouths, prey_sharing, birth_order, inheritance, parents, child_heading)
};

struct WorldConfig {
  ArenaConfig arena;
  PhysicsConfig physics;
  RuleConfig rules;
  float food_radius;
  ObstacleConfig obstacle;
  FixedList<FoodConfig, MAX_FOOD_KINDS> food;
  FixedList<SpeciesConfig, MAX_SPECIES> species;

  HEDON_FIELDS(WorldConfig, arena, physics, rules, food_radius, obstacle, food, species)
};

}  // namespace hedon
