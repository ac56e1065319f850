#include "simulation/config_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace hedon {
namespace {

constexpr double LARGEST = 1e6;  ///< of any setting that is not a count: its square, and sums of squares, are finite
constexpr float MAX_FACTOR = 1000.0f;  ///< of a schedule
constexpr int MAX_TOUCH_BITS = 128;
constexpr int64_t MAX_WALLS = 1024;
constexpr int64_t MAX_WORLDS = 1'000'000;
constexpr int64_t MAX_THREADS = 1024;

struct Limit {
  const char* path;
  int32_t low, high;
};

/// Every integer of a config. An integer that is missing here is refused, so that none is forgotten.
constexpr Limit INTEGERS[] = {
    {"physics.substeps", 1, 100},
    {"physics.velocity_passes", 1, 100},
    {"physics.position_passes", 0, 100},
    {"species.sensor.ray_count", 1, MAX_RAYS},
    {"species.sensor.touch_sectors", 1, 32},
    {"species.population.capacity", 1, 100'000},
    {"species.population.initial_count", 0, 100'000},
    {"obstacle.count", 0, MAX_OBSTACLES},
    {"obstacle.corners", 3, 8},
    {"obstacle.schedule.period", 0, 1'000'000'000},
    {"obstacle.schedule.points.step", 0, 1'000'000'000},
    {"food.capacity", 0, 100'000},
    {"food.initial_count", 0, 100'000},
    {"food.candidates", 1, 10'000},
    {"food.placement.switch_after", 1, 1'000'000'000},
    {"food.growth_schedule.period", 0, 1'000'000'000},
    {"food.growth_schedule.points.step", 0, 1'000'000'000},
    {"food.capacity_schedule.period", 0, 1'000'000'000},
    {"food.capacity_schedule.points.step", 0, 1'000'000'000},
    {"species.hazard.schedule.period", 0, 1'000'000'000},
    {"species.hazard.schedule.points.step", 0, 1'000'000'000},
    {"species.hazard.rule", 0, 1},
    {"species.birth.rule", 0, 1},
    {"species.birth.attempts", 1, 1000},
    {"species.birth.mating_window", 0, 1'000'000},
    {"species.reward.threshold_gene", -1, MAX_GENES - 1},
    {"species.reward.threshold_width_gene", -1, MAX_GENES - 1},
    {"species.diet.digestion_steps", 0, 1'000'000},
    {"species.sensor.sees", 0, MAX_TYPES - 1},
    {"species.sensor.collides", 0, MAX_TYPES - 1},
    {"species.sensor.smells", 0, MAX_TYPES - 1},
    {"species.sensor.noses", 1, 2},
    {"species.nutrient.present", 0, 1},
    {"species.nutrient.observed", 0, 1},
    {"species.toxin.present", 0, 1},
    {"species.toxin.observed", 0, 1},
    {"species.reward.set_points", -1, MAX_GENES - 1},
    {"species.reward.rule", 0, 1},
    {"species.reward.memory", 0, 16},
    {"species.reward.terms.index", 0, MAX_TYPES - 1},
    {"species.reward.terms.gene", 0, MAX_GENES - 1},
    {"species.reward.terms.second_gene", 0, MAX_GENES - 1},
    {"species.genome.learning.gene", 0, MAX_GENES - 1},
    {"species.learning.rollout_steps", 1, 65'536},
    {"species.learning.minibatch_size", 1, 65'536},
    {"species.learning.update_epochs", 0, 1000},
};

/// Settings that are divisors or steps of loops, so they must be above 0.
constexpr const char* POSITIVE[] = {"arena.width",
                                    "arena.height",
                                    "physics.dt",
                                    "physics.max_speed",
                                    "physics.max_angular_speed",
                                    "physics.max_correction",
                                    "physics.neighbor_skin",
                                    "species.body.radius",
                                    "species.body.density",
                                    "food_radius",
                                    "obstacle.min_side",
                                    "species.sensor.ray_length",
                                    "species.sensor.mouth_spread",
                                    "species.sensor.smell_decay",
                                    "species.energy.capacity",
                                    "species.nutrient.capacity",
                                    "species.toxin.threshold",
                                    "species.genome.genes.limit",
                                    "species.genome.genes.mutation_df",
                                    "species.reward.threshold_width",
                                    "species.learning.adam_epsilon",
                                    "species.learning.clip_coef"};

/// Keeps the first problem.
class Complaint {
 public:
  std::string text;

  void add(const std::string& place, double value, const std::string& rule) {
    char number[32];
    const bool whole = value == std::floor(value) && std::fabs(value) < 1e15;
    snprintf(number, sizeof number, whole ? "%.0f" : "%.9g", value);
    if (text.empty()) text = place + " = " + number + ": must be " + rule;
  }

  void need(bool good, const std::string& place, double value, const std::string& rule) {
    if (!good) add(place, value, rule);
  }
};

void check_number(Complaint& complaint, const std::string& path, const std::string& name, int32_t value) {
  for (const Limit& limit : INTEGERS) {
    if (name != limit.path) continue;
    complaint.need(value >= limit.low && value <= limit.high, path, value,
                   "from " + std::to_string(limit.low) + " to " + std::to_string(limit.high));
    return;
  }
  complaint.add(path, value, "in the engine's own list of settings");
}

void check_number(Complaint& complaint, const std::string& path, const std::string& name, float value) {
  complaint.need(std::fabs(value) <= LARGEST, path, value, "a number from -1e6 to 1e6");  // false for NaN
  for (const char* positive : POSITIVE) complaint.need(name != positive || value > 0.0f, path, value, "above 0");
}

/// Visits every number in a part of a config. `path` is its name in messages, `name` the same without indices.
template <class T>
void visit(Complaint& complaint, const std::string& path, const std::string& name, const T& value) {
  if constexpr (std::is_enum_v<T>) {
    // Filled by name, so it is valid.
  } else if constexpr (std::is_arithmetic_v<T>) {
    check_number(complaint, path, name, value);
  } else if constexpr (std::is_same_v<T, Vec2>) {
    check_number(complaint, path + "[0]", name, value.x);
    check_number(complaint, path + "[1]", name, value.y);
  } else if constexpr (requires { value.items; }) {
    for (int32_t i = 0; i < value.count; ++i)
      visit(complaint, path + "[" + std::to_string(i) + "]", name, value.items[i]);
  } else {
    const std::string dot = path.empty() ? "" : ".";
    T::for_each_field([&](const char* field, auto member) {
      visit(complaint, path + dot + field, name + dot + field, value.*member);
    });
  }
}

/// Steps rise and lie within the period, and no factor is negative or above `most`.
void check_schedule(Complaint& complaint, const std::string& path, const ScheduleConfig& schedule, float most) {
  for (int32_t i = 0; i < schedule.points.count; ++i) {
    const SchedulePoint& point = schedule.points[i];
    const bool rises = i == 0 || schedule.points[i - 1].step < point.step;
    complaint.need(rises && (schedule.period == 0 || point.step < schedule.period), path + ".points.step", point.step,
                   "above the step before, and below the period");
    complaint.need(point.factor >= 0.0f && point.factor <= most, path + ".points.factor", point.factor,
                   "from 0 to " + std::to_string(static_cast<int>(most)));
  }
}

void check_food(Complaint& complaint, const WorldConfig& config) {
  complaint.need(config.food.count >= 1, "food", config.food.count, "at least one kind");
  for (int32_t k = 0; k < config.food.count; ++k) {
    const FoodConfig& food = config.food[k];
    const PlacementConfig& place = food.placement;
    const std::string path = "food[" + std::to_string(k) + "]";
    complaint.need(food.initial_count <= food.capacity, path + ".initial_count", food.initial_count,
                   "at most the kind's capacity");
    check_schedule(complaint, path + ".growth_schedule", food.growth_schedule, MAX_FACTOR);
    check_schedule(complaint, path + ".capacity_schedule", food.capacity_schedule, 1.0f);
    if (place.form == PlacementForm::uniform) continue;
    const int32_t fewest = place.form == PlacementForm::switching ? 2 : 1;
    complaint.need(place.centers.count >= fewest, path + ".placement.centers", place.centers.count,
                   "at least " + std::to_string(fewest) + " for this form");
    complaint.need(place.sd.x > 0.0f && place.sd.y > 0.0f, path + ".placement.sd", place.sd.x, "two numbers above 0");
  }
}

/// Types of a list are ascending and exist.
void check_types(Complaint& complaint, const std::string& path, const FixedList<int32_t, MAX_TYPES>& list,
                 int32_t types) {
  for (int32_t i = 0; i < list.count; ++i)
    complaint.need(list[i] < types && (i == 0 || list[i - 1] < list[i]), path, list[i], "ascending types that exist");
}

/// Food kinds, and species if any species eats another.
int32_t meals_of(const WorldConfig& config) {
  bool hunting = false;
  for (int32_t s = 0; s < config.species.count; ++s) {
    const DietConfig& diet = config.species[s].diet;
    for (int32_t prey = 0; prey < diet.prey.count; ++prey) hunting |= diet.prey[prey] > 0.0f;
  }
  return config.food.count + (hunting ? config.species.count : 0);
}

void check_reward(Complaint& complaint, const std::string& path, const WorldConfig& config,
                  const SpeciesConfig& species) {
  complaint.need(species.reward.set_points.count == INNER_STATES, "reward.set_points", species.reward.set_points.count,
                 "one for each inner state");
  for (int32_t s = 0; s < species.reward.set_points.count; ++s)
    complaint.need(species.reward.set_points[s] < species.genome.genes.count, "reward.set_points",
                   species.reward.set_points[s], "-1 or the index of a gene");
  for (int32_t i = 0; i < species.reward.terms.count; ++i) {
    const RewardTerm& term = species.reward.terms[i];
    complaint.need(term.gene < species.genome.genes.count, path + ".gene", term.gene, "the index of a gene");
    complaint.need(term.second_gene < species.genome.genes.count, path + ".second_gene", term.second_gene,
                   "the index of a gene");
    const bool food = term.input == RewardInput::food;
    const bool sight = is_sight(term.input);
    if (food) complaint.need(term.index < meals_of(config), path + ".index", term.index, "the index of a meal");
    if (term.input == RewardInput::smell)
      complaint.need(term.index < species.sensor.smells.count, path + ".index", term.index, "a channel of smell");
    if (sight) complaint.need(term.index < species.sensor.sees.count, path + ".index", term.index, "a sight channel");
  }
}

void check_genome(Complaint& complaint, const std::string& path, const GenomeConfig& genome) {
  for (int32_t i = 0; i < genome.learning.count; ++i)
    complaint.need(genome.learning[i].gene < genome.genes.count, path + ".gene", genome.learning[i].gene,
                   "the index of a gene");
}

void check_species(Complaint& complaint, const WorldConfig& config, int32_t s) {
  const SpeciesConfig& own = config.species[s];
  const std::string path = "species[" + std::to_string(s) + "].";
  const int32_t steps = own.learning.rollout_steps, minibatch = own.learning.minibatch_size;
  const float side = config.arena.width < config.arena.height ? config.arena.width : config.arena.height;
  const int32_t types = config.species.count + config.food.count + (config.obstacle.count > 0 ? 2 : 1);
  check_types(complaint, path + "sensor.sees", own.sensor.sees, types);
  check_types(complaint, path + "sensor.collides", own.sensor.collides, types);
  check_types(complaint, path + "sensor.smells", own.sensor.smells, config.species.count + config.food.count);
  const int32_t scents = own.sensor.smells.count * own.sensor.noses;
  complaint.need(scents <= MAX_SMELLS, path + "sensor.smells", own.sensor.smells.count,
                 "at most " + std::to_string(MAX_SMELLS / own.sensor.noses));
  check_reward(complaint, path + "reward.terms", config, own);
  check_schedule(complaint, path + "hazard.schedule", own.hazard.schedule, MAX_FACTOR);
  check_genome(complaint, path + "genome.learning", own.genome);
  complaint.need(own.diet.food.count == config.food.count, path + "diet.food", own.diet.food.count,
                 "one factor for each kind of food");
  complaint.need(own.diet.prey.count == config.species.count, path + "diet.prey", own.diet.prey.count,
                 "one share for each species");
  complaint.need(own.population.initial_count <= own.population.capacity, path + "population.initial_count",
                 own.population.initial_count, "at most population.capacity");
  complaint.need(2.0f * own.body.radius < side, path + "body.radius", own.body.radius, "smaller than half the arena");
  const int32_t touches = own.sensor.collides.count * own.sensor.touch_sectors;
  complaint.need(touches <= MAX_TOUCH_BITS, path + "sensor.touch_sectors", own.sensor.touch_sectors,
                 "at most " + std::to_string(MAX_TOUCH_BITS / std::max(own.sensor.collides.count, 1)));
  complaint.need(steps % minibatch == 0, path + "learning.minibatch_size", minibatch,
                 "a divisor of learning.rollout_steps");
  complaint.need(steps == config.species[0].learning.rollout_steps, path + "learning.rollout_steps", steps,
                 "equal in all species");
  complaint.need(own.motor.min_force < own.motor.max_force, path + "motor.min_force", own.motor.min_force,
                 "below motor.max_force");
  for (const int32_t gene : {own.reward.threshold_gene, own.reward.threshold_width_gene})
    complaint.need(gene < own.genome.genes.count, path + "reward.threshold_gene", gene, "-1 or the index of a gene");
  const bool plain = own.birth.network == ChildNetwork::none && own.birth.mating == Mating::none;
  complaint.need(plain || config.rules.inheritance == Inheritance::at_birth, path + "birth.network", 0,
                 "none, as mating, where newborns inherit when the window ends");
  complaint.need(own.birth.mating_range >= 0.0f && own.birth.network_noise >= 0.0f, path + "birth.mating_range",
                 own.birth.mating_range, "at least 0, as network_noise");
  complaint.need(own.energy.initial <= own.energy.capacity, path + "energy.initial", own.energy.initial,
                 "at most energy.capacity");
}

}  // namespace

std::string check_config(const WorldConfig& config) {
  Complaint complaint;
  visit(complaint, "", "", config);
  if (!complaint.text.empty()) return complaint.text;
  const float side = config.arena.width < config.arena.height ? config.arena.width : config.arena.height;
  complaint.need(config.species.count >= 1, "species", config.species.count, "at least one");
  for (int32_t s = 0; s < config.species.count; ++s) check_species(complaint, config, s);
  complaint.need(2.0f * config.food_radius < side, "food_radius", config.food_radius, "smaller than half the arena");
  check_food(complaint, config);
  const ObstacleConfig& obstacle = config.obstacle;
  complaint.need(obstacle.min_side <= obstacle.max_side, "obstacle.min_side", obstacle.min_side,
                 "at most obstacle.max_side");
  complaint.need(obstacle.damage >= 0.0f, "obstacle.damage", obstacle.damage, "at least 0");
  check_schedule(complaint, "obstacle.schedule", obstacle.schedule, 1.0f);
  return complaint.text;
}

std::string check_arguments(const WorldConfig& config, const std::vector<Segment>& walls, int64_t outer_walls,
                            int64_t worlds, int64_t threads, const std::vector<int32_t>& slot_order) {
  Complaint complaint;
  const auto count = [&](const char* name, int64_t value, int64_t low, int64_t high) {
    complaint.need(value >= low && value <= high, name, static_cast<double>(value),
                   "from " + std::to_string(low) + " to " + std::to_string(high));
  };
  count("seeds", worlds, 1, MAX_WORLDS);
  count("threads", threads, 1, MAX_THREADS);
  count("walls", static_cast<int64_t>(walls.size()), 3, MAX_WALLS);
  count("outer_walls", outer_walls, 3, static_cast<int64_t>(walls.size()));
  for (const Segment& wall : walls) {
    for (const float at : {wall.a.x, wall.a.y, wall.b.x, wall.b.y})
      complaint.need(std::fabs(at) <= LARGEST, "walls", at, "numbers from -1e6 to 1e6");
    complaint.need(wall.a.x != wall.b.x || wall.a.y != wall.b.y, "walls", wall.a.x, "of a length above 0");
  }
  int64_t capacity = 0;
  for (int32_t s = 0; s < config.species.count; ++s) capacity += config.species[s].population.capacity;
  std::vector<char> seen(static_cast<size_t>(capacity));
  const bool whole = slot_order.empty() || slot_order.size() == seen.size();
  complaint.need(whole, "slot_order", static_cast<double>(slot_order.size()), "each slot once");
  for (const int32_t slot : slot_order) {
    const bool fresh = slot >= 0 && static_cast<size_t>(slot) < seen.size() && seen[static_cast<size_t>(slot)] == 0;
    complaint.need(fresh, "slot_order", slot, "each slot once");
    if (fresh) seen[static_cast<size_t>(slot)] = 1;
  }
  return complaint.text;
}

}  // namespace hedon
