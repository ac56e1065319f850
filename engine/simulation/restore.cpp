/// Restores a world from a checkpoint. The source of a checkpoint is not trusted, so everything that a step relies on
/// is checked before the world is changed.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/float_mode.h"
#include "simulation/inspector.h"
#include "simulation/saved.h"
#include "simulation/simulation.h"
#include "world/population.h"

namespace hedon {
namespace {

template <class T>
bool rises(const std::vector<T>& values, bool strictly) {
  for (size_t i = 1; i < values.size(); ++i) {
    if (values[i] < values[i - 1] || (strictly && values[i] == values[i - 1])) return false;
  }
  return true;
}

/// The species of each living agent, in their order.
std::vector<int32_t> saved_species(const Inspector& in, size_t living) {
  if (in.world_.shape->species == 1) return std::vector<int32_t>(living, 0);
  return in.numbers<int32_t>("species");
}

/// Reads which living agents have networks, and which of them learn.
bool read_networks(Inspector& in, SavedExtent& extent, const std::vector<int64_t>& births) {
  const WorldShape& shape = *in.world_.shape;
  if (shape.species > 1 && (!in.has<int32_t>("species", {static_cast<int64_t>(births.size())}) ||
                            !in.within<int32_t>("species", 0, shape.species - 1))) {
    return false;
  }
  size_t room = 0;
  for (int32_t s = 0; s < shape.species; ++s)
    room += shape.of[s].has_network ? static_cast<size_t>(shape.of[s].capacity()) : 0;
  const std::vector<int32_t> species = saved_species(in, births.size());
  const int64_t window_start = in.numbers<int64_t>("head.step")[0] - extent.filled;
  for (size_t i = 0; i < births.size(); ++i) {
    if (shape.of[species[i]].has_network) extent.networks.push_back(-1);  // its slot is not known yet
    if (!shape.of[species[i]].learns) continue;
    extent.learners.push_back(-1);
    extent.taught += births[i] <= window_start;
  }
  extent.free_networks.resize(room > extent.networks.size() ? room - extent.networks.size() : 0);
  return true;
}

/// Largest counts that a checkpoint may contain: sums of several do not overflow, nor does what a window adds.
constexpr double MOST_LONG = 0x1p53, MOST = INT32_MAX - 0x1p24;

/// Reads how many rows the arrays have. Slots are numbered as the world will assign them to the living agents.
bool read_extent(Inspector& in, SavedExtent& extent) {
  const WorldShape& shape = *in.world_.shape;
  if (!in.has<int64_t>("head.step", {1}) || !in.has<int32_t>("head.living_count", {1}) ||
      !in.has<int32_t>("food.slot", {-1}) || !in.within<int64_t>("head.step", 0, UINT32_MAX) ||
      !in.within<int32_t>("head.living_count", 0, shape.capacity) ||
      !in.within<int32_t>("food.slot", 0, shape.foods - 1) || !in.has<int32_t>("head.births_in_window", {1}) ||
      !in.has<int32_t>("head.eaten_food_count", {1}) || !in.within<int32_t>("head.births_in_window", 0, MOST) ||
      !in.within<int32_t>("head.eaten_food_count", 0, static_cast<double>(in.world_.state.eaten_food.count)) ||
      !in.has<int64_t>("life.birth_step", {in.numbers<int32_t>("head.living_count")[0]})) {
    return false;
  }
  extent.foods = in.numbers<int32_t>("food.slot");
  if (!rises(extent.foods, true)) return in.refuse("food.slot is out of order");
  const int64_t step = in.numbers<int64_t>("head.step")[0];
  extent.filled = step % shape.steps;
  const std::vector<int64_t> births = in.numbers<int64_t>("life.birth_step");
  if (!rises(births, false)) return in.refuse("life.birth_step is out of order");
  if (!in.within<int64_t>("life.birth_step", 0, static_cast<double>(step))) return false;
  extent.slots.resize(births.size());
  extent.free.resize(static_cast<size_t>(shape.capacity) - births.size());
  extent.eaten_foods = in.numbers<int32_t>("head.eaten_food_count")[0];
  if (!read_networks(in, extent, births)) return false;
  if (shape.newborns == 0) return true;
  extent.newborns = in.numbers<int32_t>("head.births_in_window")[0];
  return in.within<int32_t>("head.births_in_window", 0, shape.newborns);
}

/// Checks that all arrays are present, that there are no others, and that all numbers are finite and none is too large.
bool check_arrays(Inspector& in, const SavedExtent& extent, const Checkpoint& checkpoint) {
  size_t known = 1;
  bool good = true;
  for_each_saved(in.world_, extent, [&]<class T>(const std::string& name, const SavedRows<T>& rows) {
    ++known;
    good = good && in.has<T>(name, rows.shape());
    if constexpr (std::is_floating_point_v<T>) good = good && in.finite<T>(name);
    if constexpr (std::is_same_v<T, int64_t>) good = good && in.within<T>(name, -1, MOST_LONG);
  });
  for (int kind = 0; kind < 3; ++kind, known += 2) {
    good = good && in.has<int32_t>(PAIR_NAMES[kind], {-1, 2});
    good = good && in.has<float>(IMPULSE_NAMES[kind], {in.find(PAIR_NAMES[kind])->shape[0], 2});
  }
  if (good && checkpoint.size() != known) return in.refuse("there is an unknown array, or an array appears twice");
  return good;
}

/// Checks that every species has room for its living agents and its newborns.
bool check_species(Inspector& in, size_t living) {
  const WorldShape& shape = *in.world_.shape;
  if (shape.hunting && !in.within<int32_t>("digestion", 0, 1'000'000)) return false;
  if (shape.species == 1) return true;
  std::vector<int32_t> count(static_cast<size_t>(shape.species));
  for (const int32_t s : saved_species(in, living)) {
    if (++count[static_cast<size_t>(s)] > shape.of[s].capacity())
      return in.refuse("species has more agents of one species than there is room for");
  }
  return shape.newborns == 0 || in.within<int32_t>("newborn_species", 0, shape.species - 1);
}

bool check_life(Inspector& in) {
  const Config& config = *in.world_.config;
  const double step = static_cast<double>(in.numbers<int64_t>("head.step")[0]);
  const std::vector<int32_t> ids = in.numbers<int32_t>("life.agent_id");
  const double nobody = ids.empty() ? 1 : 0;
  const double last_id = ids.empty() ? 0 : ids.back();
  constexpr double LARGEST = std::numeric_limits<float>::max();
  if (!rises(ids, true)) return in.refuse("life.agent_id is out of order");
  const std::vector<int32_t> parents = in.numbers<int32_t>("life.parent_id");
  const std::vector<int32_t> generations = in.numbers<int32_t>("life.generation");
  for (size_t i = 0; i < ids.size(); ++i) {
    if (parents[i] >= ids[i]) return in.refuse("life.parent_id has an agent that is younger than its child");
    if (generations[i] > ids[i]) return in.refuse("life.generation counts more ancestors than there were agents");
  }
  return in.within<int64_t>("head.extinct_step", nobody - 1.0, nobody > 0 ? step : -1.0) &&
         in.within<int32_t>("head.next_agent_id", last_id + 1.0 - nobody, MOST) &&
         in.within<int32_t>("head.births_before", 0, MOST) && in.within<int32_t>("life.agent_id", 0, MOST) &&
         in.within<int32_t>("life.parent_id", -1, MOST) && in.within<int32_t>("life.generation", 0, MOST) &&
         in.within<int32_t>("life.children", 0, MOST) && in.within<int32_t>("eaten", 0, MOST) &&
         in.within<int64_t>("life.death_step", -1, -1) && in.within<double>("life.energy", 0, LARGEST) &&
         (in.world_.shape->stores == 1 || in.within<double>("store", 0, LARGEST)) &&
         (in.world_.shape->last == 0 || in.within<float>("last", -LARGEST, LARGEST)) &&
         (!in.world_.shape->counts_births || in.within<int32_t>("births", 0, MOST)) &&
         (!in.world_.shape->learning ||
          (in.within<int64_t>("updates", 0, MOST_LONG) && in.within<float>("second_moment", 0, LARGEST) &&
           in.zero_until_counted("first_moment", "updates") && in.zero_until_counted("second_moment", "updates"))) &&
         in.within<float>("body.x", 0, config.arena.width) && in.within<float>("body.y", 0, config.arena.height) &&
         in.within<float>("body.angle", -TWO_PI_F, TWO_PI_F);
}

/// Bits of touch that a species cannot have.
uint64_t bits_beyond(const Species& species) {
  const int32_t touches = species.network.observation.touches;
  return touches >= 64 ? 0 : ~uint64_t{0} << touches;
}

bool check_touch(Inspector& in, size_t living) {
  const std::vector<uint64_t> touch = in.numbers<uint64_t>("touch");
  const std::vector<int32_t> species = saved_species(in, living);
  for (size_t i = 0; i < touch.size(); ++i) {
    if ((touch[i] & bits_beyond(in.world_.shape->of[species[i]])) != 0)
      return in.refuse("touch has a bit that is not possible");
  }
  if (in.world_.state.touch_more.count == 0) return true;
  const std::vector<uint64_t> more = in.numbers<uint64_t>("touch_more");
  for (size_t i = 0; i < more.size(); ++i) {
    const int32_t bits = in.world_.shape->of[species[i]].network.observation.touches - 64;
    if (bits < 64 && (more[i] >> (bits > 0 ? bits : 0)) != 0) return in.refuse("touch_more has an impossible bit");
  }
  return true;
}

bool check_food(Inspector& in, const SavedExtent& extent) {
  const World& world = in.world_;
  const std::vector<double> number = in.numbers<double>("food_stock.number");
  const std::vector<int32_t> present = in.numbers<int32_t>("food_stock.present");
  const std::vector<int32_t> center = in.numbers<int32_t>("food_stock.center");
  for (int32_t k = 0; k < world.shape->kinds; ++k) {
    const size_t at = static_cast<size_t>(k);
    int32_t count = 0;
    for (const int32_t f : extent.foods)
      count += f >= world.shape->food_offset[k] && f < world.shape->food_offset[k + 1];
    const FoodConfig& config = world.config->food[k];
    const int32_t centers = config.placement.centers.count > 0 ? config.placement.centers.count : 1;
    if (present[at] != count) return in.refuse("food_stock.present differs from the foods that are there");
    if (fabs(number[at]) > config.capacity) return in.refuse("food_stock.number is above the capacity");
    if (center[at] < 0 || center[at] >= centers) return in.refuse("food_stock.center is not the index of a center");
  }
  const bool eaten =
      world.state.eaten_food.count == 0 || in.within<int32_t>("eaten_food.kind", 0, world.shape->kinds - 1);
  return eaten && in.within<int64_t>("food_stock.eaten", 0, MOST_LONG) &&
         in.within<float>("food.x", 0, world.config->arena.width) &&
         in.within<float>("food.y", 0, world.config->arena.height);
}

/// Checks the newborns that wait for their genomes: ids ascend, and each parent among them is older than its child.
bool check_newborns(Inspector& in) {
  if (in.world_.state.newborn.count == 0) return true;
  const std::vector<int32_t> ids = in.numbers<int32_t>("newborn.agent_id");
  const std::vector<int32_t> parents = in.numbers<int32_t>("newborn.parent");
  if (!rises(ids, true)) return in.refuse("newborn.agent_id is out of order");
  for (size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] < -1 || parents[i] >= static_cast<int32_t>(i))
      return in.refuse("newborn.parent is not an older newborn");
  }
  // Every agent born in this window waits, since parents are looked for among them.
  const int64_t step = in.numbers<int64_t>("head.step")[0];
  const std::vector<int64_t> births = in.numbers<int64_t>("life.birth_step");
  const std::vector<int32_t> living = in.numbers<int32_t>("life.agent_id");
  for (size_t i = 0; i < births.size(); ++i) {
    if (births[i] > step - step % in.world_.shape->steps && !std::binary_search(ids.begin(), ids.end(), living[i]))
      return in.refuse("newborn.agent_id lacks an agent born in this window");
  }
  return true;
}

/// Whether the last line of a wide observation is possible.
bool is_possible(const ObservationShape& sizes, const char* bytes) {
  ObservationExtra extra;
  memcpy(&extra, bytes, sizeof extra);
  const int32_t bits = sizes.touches - 64;
  const uint64_t beyond = bits >= 64 ? 0 : ~uint64_t{0} << (bits > 0 ? bits : 0);
  bool good = (extra.touch & beyond) == 0;
  for (int32_t d = MAX_DENSE; d < sizes.dense; ++d) good = good && std::isfinite(extra.dense[d - MAX_DENSE]);
  return good;
}

/// Checks the indices by which networks read rows: channels of rays, and bits of touch.
bool check_observations(Inspector& in, const SavedExtent& extent) {
  if (extent.filled == 0 || !in.world_.shape->learning) return true;
  std::vector<int32_t> species = saved_species(in, extent.slots.size());
  std::erase_if(species, [&](int32_t s) { return !in.world_.shape->of[s].learns; });
  const std::span<const char> bytes = in.find("observation")->bytes;
  const size_t size = static_cast<size_t>(in.world_.shape->lines) * sizeof(ObservationLine);
  for (size_t at = 0; at < bytes.size(); at += size) {
    const Species& own = in.world_.shape->of[species[at / (static_cast<size_t>(extent.filled) * size)]];
    const ObservationShape& sizes = own.network.observation;
    const uint64_t beyond = bits_beyond(own);
    PackedObservation one;
    memcpy(&one, &bytes[at], sizeof one);
    if (sizes.wide() && !is_possible(sizes, &bytes[at + sizeof one]))
      return in.refuse("observation has values that are not possible");
    bool good = (one.touch & beyond) == 0;
    for (int r = 0; r < PACKED_RAYS; ++r) good = good && one.ray_type[r] < sizes.types && std::isfinite(one.ray[r]);
    for (const float value : one.dense) good = good && std::isfinite(value);
    if (!good) return in.refuse("observation has values that are not possible");
  }
  return true;
}

bool check_pairs(Inspector& in, const SavedExtent& extent) {
  const NeighborList& list = in.world_.state.physics.neighbors;
  const PairList* lists[] = {&list.bodies, &list.circles, &list.walls};
  const int32_t living = static_cast<int32_t>(extent.slots.size());
  const int32_t others[] = {living, in.world_.shape->foods, in.world_.shape->walls};
  for (int kind = 0; kind < 3; ++kind) {
    const std::vector<int32_t> who = in.numbers<int32_t>(PAIR_NAMES[kind]);
    const std::vector<float> impulse = in.numbers<float>(IMPULSE_NAMES[kind]);
    int64_t before = -1;
    for (size_t i = 0; i < who.size(); i += 2) {
      const int32_t first = who[i], second = who[i + 1];
      const int64_t key = int64_t{first} << 32 | second;
      const bool good = first >= 0 && first < living && second >= 0 && second < others[kind] &&
                        (kind > 0 || first < second) && key > before && impulse[i] >= 0.0f &&
                        std::isfinite(impulse[i]) && std::isfinite(impulse[i + 1]);
      if (!good) return in.refuse(std::string(PAIR_NAMES[kind]) + " has a pair that is not possible");
      before = key;
    }
    if (static_cast<int64_t>(who.size() / 2) > lists[kind]->first.count)
      return in.refuse(std::string(PAIR_NAMES[kind]) + " has more pairs than the neighbor list can hold");
  }
  return true;
}

/// Lists the pairs with impulses, with bodies in the order of their ids. The next step builds its own list from this.
void restore_pairs(const Inspector& in, const World& world, const SavedExtent& extent) {
  const NeighborList& list = world.state.physics.neighbors;
  NeighborHead& head = list.head[0];
  head.bodies = static_cast<int32_t>(extent.slots.size());
  for (int32_t index = 0; index < head.bodies; ++index) {
    list.slot[index] = extent.slots[static_cast<size_t>(index)];
    list.index[list.slot[index]] = index;
  }
  const PairList* lists[] = {&list.bodies, &list.circles, &list.walls};
  for (int kind = 0; kind < 3; ++kind) {
    const PairList& pairs = *lists[kind];
    const std::vector<int32_t> who = in.numbers<int32_t>(PAIR_NAMES[kind]);
    const std::vector<float> impulse = in.numbers<float>(IMPULSE_NAMES[kind]);
    const int32_t count = static_cast<int32_t>(who.size() / 2);
    for (int32_t pair = 0, index = 0; index <= head.bodies; ++index) {
      while (pair < count && who[2 * static_cast<size_t>(pair)] < index) ++pair;
      pairs.start[index] = pair;
    }
    for (int32_t pair = 0; pair < count; ++pair) {
      const size_t at = 2 * static_cast<size_t>(pair);
      pairs.first[pair] = who[at];
      pairs.second[pair] = who[at + 1];
      pairs.normal_impulse[pair] = impulse[at];
      pairs.tangent_impulse[pair] = impulse[at + 1];
    }
  }
}

/// Checks everything that a step relies on, and reads how many rows there are.
bool check_all(Inspector& in, SavedExtent& extent, const Checkpoint& checkpoint) {
  return read_extent(in, extent) && check_arrays(in, extent, checkpoint) && check_species(in, extent.slots.size()) &&
         check_life(in) && check_touch(in, extent.slots.size()) && check_food(in, extent) && check_newborns(in) &&
         check_observations(in, extent) && check_pairs(in, extent);
}

/// Reads the slot of each agent, and checks that every slot occurs once and belongs to the right species.
bool read_slots(Inspector& in, std::span<const char> saved, const SavedExtent& extent, std::vector<int32_t>& slots) {
  const WorldShape& shape = *in.world_.shape;
  const auto refuse = [&] { return in.refuse("the slots are not those of such a world"); };
  slots.resize(saved.size() / sizeof(int32_t));
  if (saved.size() != static_cast<size_t>(shape.capacity) * sizeof(int32_t)) return refuse();
  memcpy(slots.data(), saved.data(), saved.size());
  std::vector<int32_t> species = saved_species(in, extent.slots.size());
  std::vector<int32_t> left(static_cast<size_t>(shape.species));
  for (int32_t s = 0; s < shape.species; ++s) left[static_cast<size_t>(s)] = shape.of[s].capacity();
  for (const int32_t s : species) --left[static_cast<size_t>(s)];
  for (int32_t s = 0; s < shape.species; ++s)
    species.insert(species.end(), static_cast<size_t>(left[static_cast<size_t>(s)]), s);
  std::vector<bool> seen(slots.size());
  for (size_t i = 0; i < slots.size(); ++i) {
    const int32_t slot = slots[i];
    if (slot < 0 || slot >= shape.capacity || shape.species_of(slot) != species[i] || seen[static_cast<size_t>(slot)])
      return refuse();
    seen[static_cast<size_t>(slot)] = true;
  }
  return true;
}

/// Fills an empty world; `slots` come from `read_slots`, or are empty if any slots will do.
void fill(const Inspector& in, World& target, SavedExtent& extent, const std::vector<int32_t>& slots = {}) {
  const WorldState& state = target.state;
  const std::vector<int32_t> species = saved_species(in, extent.slots.size());
  for (size_t i = 0; i < extent.slots.size(); ++i) {
    const int32_t free = take_free_slot(target, species[i]);
    const int32_t slot = slots.empty() ? free : slots[i];
    extent.slots[i] = slot;
    state.living[static_cast<int64_t>(i)] = slot;
    state.alive[slot] = 1;
  }
  size_t next = extent.slots.size();
  for (int32_t s = 0; s < target.shape->species && !slots.empty(); ++s) {
    for (int32_t i = 0; i < state.free_count[s]; ++i) state.free[target.shape->of[s].first_slot + i] = slots[next++];
  }
  extent.free = free_slots(target);
  list_networks(target, extent);
  for_each_saved(target, extent, [&]<class T>(const std::string& name, const SavedRows<T>& rows) {
    const char* from = in.find(name)->bytes.data();
    for (int64_t i = 0; i < rows.count; ++i, from += rows.row_bytes()) memcpy(rows.row(i), from, rows.row_bytes());
  });
  for (const int32_t slot : extent.slots) express_settings(target, slot);
  for (const int32_t food : extent.foods) state.physics.circles.present[food] = 1;
  for (const int32_t slot : extent.networks)
    target.kernel->network.pack_weights(target.species(slot).network, target.network(slot));
  if (inherits_late(target)) {
    for (const int32_t slot : extent.free_networks)
      target.kernel->network.pack_weights(target.species(slot).network, target.network(slot));
  }
  restore_pairs(in, target, extent);
}

}  // namespace

std::string Simulation::restore(int index, const Checkpoint& checkpoint) {
  const FloatMode mode(flush_);
  World& target = world(index);
  Inspector in(target, checkpoint);
  SavedExtent extent{};
  if (!check_all(in, extent, checkpoint)) return in.complaint;
  empty(target);
  fill(in, target, extent);
  return "";
}

std::string Simulation::restore(const std::vector<SavedWorld>& saved) {
  const FloatMode mode(flush_);
  if (saved.size() != worlds_.size())
    return "there are " + std::to_string(saved.size()) + " worlds, here " + std::to_string(worlds_.size());
  std::vector<Inspector> inspectors;
  std::vector<SavedExtent> extents(saved.size());
  std::vector<std::vector<int32_t>> slots(saved.size());
  for (int i = 0; i < world_count(); ++i) {
    const size_t at = static_cast<size_t>(i);
    Inspector& in = inspectors.emplace_back(numbers(i), saved[at].arrays);
    if (!check_all(in, extents[at], saved[at].arrays) || !read_slots(in, saved[at].slots, extents[at], slots[at]))
      return "world " + std::to_string(i) + ": " + in.complaint;
  }
  for (int i = 0; i < world_count(); ++i) {
    const size_t at = static_cast<size_t>(i);
    World& target = world(i);
    target.seed = saved[at].seed;
    empty(target);
    fill(inspectors[at], target, extents[at], slots[at]);
  }
  return "";
}

}  // namespace hedon
