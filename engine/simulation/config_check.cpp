#include "simulation/config_check.h"

#include <cmath>
#include <cstdio>
#include <cstring>

namespace hedon {
namespace {

constexpr double LARGEST = 1e6;  ///< of any setting that is not a count: its square, and sums of squares, are finite
constexpr int MAX_TOUCH_BITS = 64;
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
    {"sensor.ray_count", 1, MAX_RAYS},
    {"sensor.touch_sectors", 1, 16},
    {"population.capacity", 1, 100'000},
    {"population.initial_count", 1, 100'000},
    {"food.capacity", 0, 100'000},
    {"food.initial_count", 0, 100'000},
    {"food.candidates", 1, 10'000},
    {"food.placement.switch_after", 1, 1'000'000'000},
    {"birth.attempts", 1, 1000},
    {"genome.neutral_count", 0, 16},
    {"learning.rollout_steps", 1, 65'536},
    {"learning.minibatch_size", 1, 65'536},
    {"learning.update_epochs", 0, 1000},
};

/// Settings that are divisors or steps of loops, so they must be above 0.
constexpr const char* POSITIVE[] = {"arena.width",
                                    "arena.height",
                                    "physics.dt",
                                    "physics.max_speed",
                                    "physics.max_angular_speed",
                                    "physics.max_correction",
                                    "physics.neighbor_skin",
                                    "body.radius",
                                    "body.density",
                                    "body.food_radius",
                                    "sensor.ray_length",
                                    "sensor.mouth_spread",
                                    "energy.capacity",
                                    "genome.weight_limit",
                                    "learning.adam_epsilon",
                                    "learning.clip_coef"};

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

void check_food(Complaint& complaint, const WorldConfig& config) {
  complaint.need(config.food.count >= 1, "food", config.food.count, "at least one kind");
  complaint.need(config.genome.food.count == config.food.count, "genome.food", config.genome.food.count,
                 "one gene for each kind of food");
  for (int32_t k = 0; k < config.food.count; ++k) {
    const FoodConfig& food = config.food[k];
    const PlacementConfig& place = food.placement;
    const std::string path = "food[" + std::to_string(k) + "]";
    complaint.need(food.initial_count <= food.capacity, path + ".initial_count", food.initial_count,
                   "at most the kind's capacity");
    if (place.form == PlacementForm::uniform) continue;
    const int32_t fewest = place.form == PlacementForm::switching ? 2 : 1;
    complaint.need(place.centers.count >= fewest, path + ".placement.centers", place.centers.count,
                   "at least " + std::to_string(fewest) + " for this form");
    complaint.need(place.sd.x > 0.0f && place.sd.y > 0.0f, path + ".placement.sd", place.sd.x, "two numbers above 0");
  }
}

}  // namespace

std::string check_config(const WorldConfig& config) {
  Complaint complaint;
  visit(complaint, "", "", config);
  if (!complaint.text.empty()) return complaint.text;
  const int32_t steps = config.learning.rollout_steps, minibatch = config.learning.minibatch_size;
  const float side = config.arena.width < config.arena.height ? config.arena.width : config.arena.height;
  const int32_t types = config.food.count + 2;
  complaint.need(config.population.initial_count <= config.population.capacity, "population.initial_count",
                 config.population.initial_count, "at most population.capacity");
  complaint.need(2.0f * config.body.radius < side, "body.radius", config.body.radius, "smaller than half the arena");
  complaint.need(2.0f * config.body.food_radius < side, "body.food_radius", config.body.food_radius,
                 "smaller than half the arena");
  complaint.need(types * config.sensor.touch_sectors <= MAX_TOUCH_BITS, "sensor.touch_sectors",
                 config.sensor.touch_sectors, "at most " + std::to_string(MAX_TOUCH_BITS / types));
  complaint.need(steps % minibatch == 0, "learning.minibatch_size", minibatch, "a divisor of learning.rollout_steps");
  complaint.need(config.motor.min_force < config.motor.max_force, "motor.min_force", config.motor.min_force,
                 "below motor.max_force");
  complaint.need(config.energy.initial <= config.energy.capacity, "energy.initial", config.energy.initial,
                 "at most energy.capacity");
  check_food(complaint, config);
  return complaint.text;
}

std::string check_company(const WorldConfig& config, const std::vector<Segment>& walls, int64_t outer_walls,
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
  std::vector<char> seen(static_cast<size_t>(config.population.capacity));
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
