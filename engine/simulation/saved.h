/// The arrays of a world that a checkpoint holds, and the places of their rows: one list for saving and restoring.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "simulation/checkpoint.h"
#include "world/world.h"

namespace hedon {

/// Numbers of rows in the arrays of a checkpoint, and their slots.
struct Extent {
  std::vector<int32_t> slots;  ///< of the living, in the order of their ids
  std::vector<int32_t> free;   ///< free slots in the order of their stack
  std::vector<int32_t> foods;  ///< slots of the foods present, ascending
  int64_t newborns;            ///< births of this window that wait for their genomes
  int64_t ghosts;              ///< foods just eaten that are still seen
  int64_t learners;            ///< number of the living that were there when the window began; they come first
  int64_t filled;              ///< steps done in the window
};

/// Rows of one array in the memory of a world: row i begins `stride` bytes times index[i] (or i) after `first`.
template <class T>
struct SavedRows {
  T* first;
  int64_t stride;
  const int32_t* index;  ///< null if the rows are consecutive
  int64_t count;
  int64_t width;  ///< numbers in a row; 0 for an array of one dimension

  char* row(int64_t i) const {
    return reinterpret_cast<char*>(first) + stride * (index == nullptr ? i : int64_t{index[i]});
  }
  size_t row_bytes() const { return static_cast<size_t>(width == 0 ? 1 : width) * sizeof(T); }
  std::vector<int64_t> shape() const {
    return width == 0 ? std::vector<int64_t>{count} : std::vector<int64_t>{count, width};
  }
};

/// Fields of `WorldHead` that follow from others, or that count what a reader has taken.
inline bool is_derived(const char* head_field) {
  return strcmp(head_field, "free_count") == 0 || strcmp(head_field, "event_count") == 0 ||
         strcmp(head_field, "reserved") == 0;
}

/// Calls visit(name, SavedRows) for each array of a checkpoint except `food.slot` and the impulses. Between two windows
/// there are no rollouts.
template <class Visit>
void for_each_saved(const World& world, const Extent& extent, Visit&& visit) {
  const WorldState& state = world.state;
  const WorldShape& shape = *world.shape;
  const int64_t living = static_cast<int64_t>(extent.slots.size());
  const int64_t steps = shape.steps;

  const auto columns = [&]<class Struct>(const std::string& prefix, Struct* first, const int32_t* index, int64_t count,
                                         auto&& skip) {
    Struct::for_each_field([&](const char* name, auto member) {
      using T = std::remove_cvref_t<decltype(first->*member)>;
      if (!skip(name)) visit(prefix + name, SavedRows<T>{&(first->*member), sizeof(Struct), index, count, 0});
    });
  };
  const auto by_slot = [&]<class T>(const std::string& name, const Array<T>& array, int64_t width) {
    visit(name, SavedRows<T>{array.data, (width == 0 ? 1 : width) * static_cast<int64_t>(sizeof(T)),
                             extent.slots.data(), living, width});
  };
  // The rows of the window so far, for the agents that will learn from it.
  const auto rollout = [&]<class T>(const std::string& name, T* first, int64_t rows, int64_t row_width) {
    visit(name, SavedRows<T>{first, rows * row_width * static_cast<int64_t>(sizeof(T)), extent.slots.data(),
                             extent.learners, extent.filled * row_width});
  };
  const auto keep_all = [](const char*) { return false; };

  columns("head.", state.head.data, nullptr, 1, is_derived);
  columns("counters.", state.counters.data, nullptr, 1, keep_all);
  columns("food_stock.", state.food_stock.data, nullptr, shape.kinds, keep_all);
  const int64_t number = sizeof(float);
  const int32_t* foods = extent.foods.data();
  const int64_t present = static_cast<int64_t>(extent.foods.size());
  visit("food.x", SavedRows<float>{state.physics.circles.x.data, number, foods, present, 0});
  visit("food.y", SavedRows<float>{state.physics.circles.y.data, number, foods, present, 0});
  columns("life.", state.life.data, extent.slots.data(), living, keep_all);
  by_slot("eaten", state.eaten, shape.kinds);
  by_slot("genome", state.genome, shape.genome.size());
  by_slot("touch", state.touch, 0);
  BodyState::for_each_field(
      [&](const char* name, auto member) { by_slot(std::string("body.") + name, state.physics.bodies.*member, 0); });
  by_slot("params", state.params, shape.network.size());
  by_slot("first_moment", state.first_moment, shape.network.size());
  by_slot("second_moment", state.second_moment, shape.network.size());
  by_slot("updates", state.updates, 0);
  if (state.ghost.count > 0) columns("ghost.", state.ghost.data, nullptr, extent.ghosts, keep_all);
  // With some rules of birth the free slots matter too: the next newborns find there what the dead have left.
  const auto by_free_slot = [&]<class T>(const std::string& name, const Array<T>& array, int64_t width) {
    visit(name, SavedRows<T>{array.data, (width == 0 ? 1 : width) * static_cast<int64_t>(sizeof(T)), extent.free.data(),
                             static_cast<int64_t>(extent.free.size()), width});
  };
  if (state.old_slot.count > 0) {
    by_slot("old_slot", state.old_slot, 0);
    by_free_slot("free.old_slot", state.old_slot, 0);
  }
  if (state.newborn.count > 0) {
    by_free_slot("free.params", state.params, shape.network.size());
    by_free_slot("free.genome", state.genome, shape.genome.size());
    columns("newborn.", state.newborn.data, nullptr, extent.newborns, keep_all);
    const int64_t genes = shape.genome.size();
    visit("newborn.genome",
          SavedRows<float>{state.newborn_genome.data, genes * number, nullptr, extent.newborns, genes});
  }
  if (extent.filled == 0) return;
  rollout("observation", reinterpret_cast<uint8_t*>(state.observation.data), steps + 1, sizeof(PackedObservation));
  rollout("action", state.action.data, steps, ACTIONS);
  rollout("log_prob", state.log_prob.data, steps, 1);
  rollout("value", state.value.data, steps, 1);
  rollout("reward", state.reward.data, steps, 1);
}

/// An array of a checkpoint, without values.
template <class T>
SavedArray make_saved(const std::string& name, std::vector<int64_t> shape) {
  const NumberKind kind = std::is_floating_point_v<T>
                              ? NumberKind::real
                              : (std::is_signed_v<T> ? NumberKind::integer : NumberKind::natural);
  int64_t count = 1;
  for (const int64_t length : shape) count *= length;
  const size_t bytes = static_cast<size_t>(count) * sizeof(T);
  return {name, kind, static_cast<int32_t>(sizeof(T)), std::move(shape), std::vector<char>(bytes)};
}

/// Names of the pairs of the three kinds, and of their impulses.
inline constexpr const char* PAIR_NAMES[] = {"pair.body", "pair.circle", "pair.wall"};
inline constexpr const char* IMPULSE_NAMES[] = {"impulse.body", "impulse.circle", "impulse.wall"};

}  // namespace hedon
