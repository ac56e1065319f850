#include "simulation/config_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <type_traits>

#include "learning/observation.h"
#include "world/own.h"

namespace hedon {
namespace {

constexpr double LARGEST = 1e6;  ///< of any number of a wall: its square, and sums of squares, are finite
constexpr int64_t MAX_WALLS = 1024;
constexpr int64_t MAX_WORLDS = 1'000'000;
constexpr int64_t MAX_THREADS = 1024;

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

std::string item(const std::string& path, int32_t i) { return path + "[" + std::to_string(i) + "]"; }

std::string words(const Limit& limit) {
  char text[80];
  const char* const low = limit.above ? "above %.10g and at most %.10g" : "from %.10g to %.10g";
  snprintf(text, sizeof text, limit.below ? "at least %.10g and below %.10g" : low, limit.low, limit.high);
  return text;
}

/// Steps ascend and are within the period; factors are within their limit.
void check_schedule(Complaint& complaint, const std::string& path, const ScheduleConfig& schedule, const Limit& limit) {
  for (int32_t i = 0; i < schedule.points.count; ++i) {
    const SchedulePoint& point = schedule.points[i];
    const bool rises = i == 0 || schedule.points[i - 1].step < point.step;
    complaint.need(rises && (schedule.period == 0 || point.step < schedule.period), path + ".points", point.step,
                   "above the step before, and below the period");
    if (!limit.allows(point.factor)) complaint.add(path + ".points", point.factor, words(limit));
  }
}

template <class T>
constexpr size_t count_fields() {
  size_t count = 0;
  T::for_each_field([&](const char*, auto) { ++count; });
  return count;
}

/// Checks every number in a part of a config against its limit.
template <class T>
void check_limits(Complaint& complaint, const std::string& path, const T& value, const Limit& limit) {
  if constexpr (std::is_enum_v<T>) {
    // Filled by name, so it is valid.
  } else if constexpr (std::is_arithmetic_v<T>) {
    if (!limit.allows(value)) complaint.add(path, value, words(limit));
  } else if constexpr (Pair<T>) {
    for_each_part(value, [&](int i, const auto& part) { check_limits(complaint, item(path, i), part, limit); });
  } else if constexpr (requires { value.items; }) {
    for (int32_t i = 0; i < value.count; ++i) check_limits(complaint, item(path, i), value.items[i], limit);
  } else {
    static_assert(count_fields<T>() == std::size(T::LIMITS), "each field has a limit");
    const Limit* next = T::LIMITS;
    T::for_each_field([&](const char* field, auto member) {
      check_limits(complaint, path.empty() ? field : path + "." + field, value.*member, *next++);
    });
    if constexpr (std::is_same_v<T, ScheduleConfig>) check_schedule(complaint, path, value, limit);
  }
}

void check_food(Complaint& complaint, const Config& config) {
  complaint.need(config.food.count >= 1, "food", config.food.count, "at least one kind");
  for (int32_t k = 0; k < config.food.count; ++k) {
    const FoodConfig& food = config.food[k];
    const PlacementConfig& place = food.placement;
    const std::string path = item("food", k);
    complaint.need(food.initial_count <= food.capacity, path + ".initial_count", food.initial_count,
                   "at most the kind's capacity");
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
int32_t meals_of(const Config& config) {
  bool hunting = false;
  for (int32_t s = 0; s < config.species.count; ++s) {
    const SpeciesLayout& layout = config.layout[s];
    for (int32_t prey = 0; prey < layout.eats_species.count; ++prey) hunting |= layout.eats_species[prey] > 0.0f;
  }
  return config.food.count + (hunting ? config.species.count : 0);
}

/// A gene exists, or is -1 if there may be none.
void check_gene(Complaint& complaint, const std::string& path, const SpeciesLayout& layout, int32_t gene) {
  complaint.need(gene < layout.genes.count, path, gene, "the index of a gene");
}

/// The number of values that a source of channels has for a species.
int32_t numbers_of(ChannelSource source, const Config& config, int32_t s) {
  const SpeciesLayout& layout = config.layout[s];
  const SpeciesConfig& species = config.species[s];
  switch (CHANNEL_OF[static_cast<int>(source)]) {
    case ChannelOf::one:
      return 1;
    case ChannelOf::two:
    case ChannelOf::season:
      return 2;
    case ChannelOf::stores:
      return 1 + species.store.count;
    case ChannelOf::meals:
      return meals_of(config);
    case ChannelOf::sees:
      return layout.sees.count;
    case ChannelOf::smells:
      return layout.smells.count;
    case ChannelOf::noses:
      return layout.smells.count * species.sensor.noses;
    case ChannelOf::touches:
      return layout.touches.count;
    case ChannelOf::harm:
      return config.obstacle.count > 0 ? 1 : 0;
    case ChannelOf::mates:
      return species.birth.mating == BirthMating::pairs ? 1 : 0;
    case ChannelOf::drive:
      return layout.set_points.count > 0 ? 1 : 0;
    case ChannelOf::queries:
    case ChannelOf::companies:
      return layout.neighbors.count;
    case ChannelOf::last:
      return layout.last.count;
  }
  return 0;
}

/// A channel refers to an existing value.
void check_channel(Complaint& complaint, const std::string& path, const Channel& channel, const Config& config,
                   int32_t s) {
  complaint.need(channel.index < numbers_of(channel.source, config, s), path + ".index", channel.index,
                 "a number of its source");
}

void check_channels(Complaint& complaint, const std::string& path, const Config& config, int32_t s) {
  const SpeciesLayout& layout = config.layout[s];
  const auto check = [&](const char* name, const FixedList<Channel, MAX_CHANNELS>& list) {
    for (int32_t i = 0; i < list.count; ++i) check_channel(complaint, item(path + name, i), list[i], config, s);
  };
  check("observed", layout.observed);
  check("last", layout.last);
  check("recorded", layout.recorded);
  check_channel(complaint, path + "gate", layout.gate, config, s);
  for (int32_t i = 0; i < layout.last.count; ++i)
    complaint.need(layout.last[i].source != ChannelSource::last, item(path + "last", i) + ".source", i,
                   "of the step itself");
  for (int32_t i = 0; i < layout.terms.count; ++i) {
    const std::string place = item(path + "terms", i);
    check_channel(complaint, place + ".channel", layout.terms[i].channel, config, s);
    check_gene(complaint, place + ".gene", layout, layout.terms[i].gene);
    check_gene(complaint, place + ".second_gene", layout, layout.terms[i].second_gene);
  }
}

void check_layout(Complaint& complaint, const std::string& path, const Config& config, int32_t s) {
  const SpeciesLayout& own = config.layout[s];
  const int32_t types = config.species.count + config.food.count + (config.obstacle.count > 0 ? 2 : 1);
  check_types(complaint, path + "sees", own.sees, types);
  complaint.need(own.looks.count == types, path + "looks", own.looks.count, "one for each type");
  for (int32_t t = 0; t < own.looks.count; ++t) {
    const int32_t like = own.looks[t];
    const bool good = like < types && (like == t || own.looks[like] == like);
    complaint.need(good, item(path + "looks", t), like, "a type that looks like itself");
    for (int32_t c = 0; c < own.sees.count; ++c)
      complaint.need(like == t || own.sees[c] != t, item(path + "sees", c), t, "a type that looks like itself");
  }
  check_types(complaint, path + "touches", own.touches, types);
  check_types(complaint, path + "smells", own.smells, config.species.count + config.food.count);
  const int32_t stores = 1 + config.species[s].store.count;
  complaint.need(own.observed.count <= MAX_DENSE + MAX_EXTRA_DENSE, path + "observed", own.observed.count,
                 "at most " + std::to_string(MAX_DENSE + MAX_EXTRA_DENSE));
  check_channels(complaint, path, config, s);
  for (int32_t i = 0; i < own.learning.count; ++i)
    check_gene(complaint, path + "learning.gene", own, own.learning[i].gene);
  const auto count = [&](const char* list, int32_t items, int32_t wanted, const char* rule) {
    complaint.need(items == wanted, path + list, items, rule);
  };
  count("eats_food", own.eats_food.count, config.food.count, "one factor for each kind of food");
  count("eats_species", own.eats_species.count, config.species.count, "one share for each species");
  count("rules", own.rules.count, RULE_USES, "one for each use of a rule");
  count("family", own.family.count, FAMILY_GENES, "one for each setting of a family that a gene may set");
  count("set_points", own.set_points.count, stores, "one for each store");
  count("gives", own.gives.count, config.food.count * stores, "one for each kind of food and each store");
  count("needs", own.needs.count, config.food.count * stores, "one for each kind of food and each store");
  for (int32_t i = 0; i < own.sets.count; ++i) {
    if (own.sets[i].sets == GenomeSet::body_radius && own.sets[i].gene < own.genes.count) {
      const double most = config.species[s].body.radius * std::pow(10.0, own.genes[own.sets[i].gene].limit());
      complaint.need(2.0 * most < std::min(config.arena.width, config.arena.height), path + "sets", most,
                     "a radius that fits into the arena");
    }
    check_gene(complaint, path + "sets.gene", own, own.sets[i].gene);
    complaint.need(own.sets[i].store < stores, path + "sets.store", own.sets[i].store, "a store of the species");
  }
  for (int32_t i = 0; i < own.family.count; ++i) check_gene(complaint, path + "family", own, own.family[i]);
  for (int32_t i = 0; i < own.set_points.count; ++i) check_gene(complaint, path + "set_points", own, own.set_points[i]);
  complaint.need(own.min_force < own.max_force, path + "min_force", own.min_force, "below max_force");
}

void check_species(Complaint& complaint, const std::string& path, const Config& config, int32_t s) {
  const SpeciesConfig& own = config.species[s];
  const int32_t steps = config.world.rollout_steps, minibatch = own.learning.minibatch_size;
  const float side = std::min(config.arena.width, config.arena.height);
  const int32_t touched = config.layout[s].touches.count;
  complaint.need(own.population.initial_count <= own.population.capacity, path + "population.initial_count",
                 own.population.initial_count, "at most population.capacity");
  const bool late = config.world.inheritance == WorldInheritance::at_window_end;
  complaint.need(!late || !sets_body(config.layout[s]), path + "genome.set", 0,
                 "without genes of bodies where newborns inherit when the window ends");
  complaint.need(2.0f * own.body.radius < side, path + "body.radius", own.body.radius, "smaller than half the arena");
  complaint.need(touched * own.sensor.touch_sectors <= MAX_TOUCH_BITS, path + "sensor.touch_sectors",
                 own.sensor.touch_sectors, "at most " + std::to_string(MAX_TOUCH_BITS / std::max(touched, 1)));
  complaint.need(steps % minibatch == 0, path + "learning.minibatch_size", minibatch,
                 "a divisor of world.rollout_steps");
  const bool plain = own.birth.network == BirthNetwork::none && own.birth.mating == BirthMating::none;
  complaint.need(plain || config.world.inheritance == WorldInheritance::at_birth, path + "birth.network", 0,
                 "none, as mating, where newborns inherit when the window ends");
  for (int32_t i = 0; i <= own.store.count; ++i) {
    const StoreConfig& store = store_of(own, i);
    const std::string place = path + (i == ENERGY ? "energy" : item("store", i - 1));
    complaint.need(store.initial <= store.capacity, place + ".initial", store.initial, "at most its capacity");
  }
}

}  // namespace

std::string check_config(const Config& config) {
  Complaint complaint;
  check_limits(complaint, "", config, Limit());
  complaint.need(config.species.count >= 1, "species", config.species.count, "at least one");
  complaint.need(config.layout.count == config.species.count, "layout", config.layout.count, "one for each species");
  if (!complaint.text.empty()) return complaint.text;
  for (int32_t s = 0; s < config.species.count; ++s) {
    check_species(complaint, item("species", s) + ".", config, s);
    check_layout(complaint, item("layout", s) + ".", config, s);
  }
  const float side = std::min(config.arena.width, config.arena.height);
  complaint.need(2.0f * config.world.food_radius < side, "world.food_radius", config.world.food_radius,
                 "smaller than half the arena");
  check_food(complaint, config);
  const ObstacleConfig& obstacle = config.obstacle;
  complaint.need(obstacle.min_side <= obstacle.max_side, "obstacle.min_side", obstacle.min_side,
                 "at most obstacle.max_side");
  complaint.need(obstacle.min_angle <= obstacle.max_angle, "obstacle.min_angle", obstacle.min_angle,
                 "at most obstacle.max_angle");
  complaint.need(obstacle.cell == 0.0f || obstacle.cell >= 1.0f, "obstacle.cell", obstacle.cell, "0 or at least 1");
  complaint.need(obstacle.cell <= side, "obstacle.cell", obstacle.cell, "at most the shorter side of the arena");
  return complaint.text;
}

std::string check_arguments(const Config& config, const std::vector<Segment>& walls, int64_t outer_walls,
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
