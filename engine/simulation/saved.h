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
struct SavedExtent {
  std::vector<int32_t> slots;          ///< of the living, in the order of their ids
  std::vector<int32_t> networks;       ///< living agents that act by networks
  std::vector<int32_t> learners;       ///< living agents whose species learns
  std::vector<int32_t> free;           ///< free slots: see `free_slots`
  std::vector<int32_t> free_networks;  ///< free slots of species that act by networks
  std::vector<int32_t> foods;          ///< slots of the foods present, ascending
  int64_t newborns;                    ///< births of this window that wait for their genomes
  int64_t eaten_foods;                 ///< foods just eaten that are still seen
  int64_t taught;                      ///< number of learners that were alive when the window began; they come first
  int64_t filled;                      ///< steps done in the window
};

/// The free slots, species by species, each in the order of its stack.
inline std::vector<int32_t> free_slots(const World& world) {
  std::vector<int32_t> slots;
  for (int32_t s = 0; s < world.shape->species; ++s) {
    const int32_t* first = world.state.free.data + world.shape->of[s].first_slot;
    slots.insert(slots.end(), first, first + world.state.free_count[s]);
  }
  return slots;
}

/// The slots of a list whose species meets a condition.
inline std::vector<int32_t> slots_of(const World& world, bool Species::* is_so, const std::vector<int32_t>& slots) {
  std::vector<int32_t> found;
  for (const int32_t slot : slots) {
    if (world.species(slot).*is_so) found.push_back(slot);
  }
  return found;
}

/// Sets the lists of networks and learners from the lists of slots.
inline void list_networks(const World& world, SavedExtent& extent) {
  extent.networks = slots_of(world, &Species::has_network, extent.slots);
  extent.learners = slots_of(world, &Species::learns, extent.slots);
  extent.free_networks = slots_of(world, &Species::has_network, extent.free);
}

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

/// The rows of all arrays of a checkpoint except `food.slot` and the impulses, for visit(name, SavedRows). The field
/// list of `WorldState` determines which arrays there are; between two windows there are no rollouts.
template <class Visit>
class SavedArrays {
 public:
  SavedArrays(const World& world, const SavedExtent& extent, Visit& visit)
      : state_(world.state), shape_(*world.shape), extent_(extent), visit_(visit) {}

  void all() {
    WorldState::for_each_shape([&](const char* name, auto member, ArrayShape size) {
      using Field = std::remove_cvref_t<decltype(state_.*member)>;
      if constexpr (std::is_same_v<Field, PhysicsState>) {
        bodies();
      } else {
        one(name, state_.*member, size);
      }
    });
  }

 private:
  template <class T>
  void one(const std::string& name, const Array<T>& array, ArrayShape size) {
    const int64_t width = size.width == Extent::one ? 0 : hedon::extent(shape_, size.width, 1);
    if (size.lifetime == Lifetime::rollout) rollout(name, array, width);
    if (size.lifetime != Lifetime::saved) return;
    // Arrays for rules that the world does not have are omitted.
    if (array.count == 0 && size.rows != Extent::slots) return;
    if (is_by_slot(size.rows)) {
      by_slot(name, array, width, slots_with(size.rows));
    } else if (size.rows == Extent::newborns || size.rows == Extent::mixed_newborns) {
      if (name == "newborn") free_slots();
      columns(name, array.data, nullptr, extent_.newborns, width);
    } else if (size.rows == Extent::eaten_foods) {
      columns(name, array.data, nullptr, extent_.eaten_foods, width);
    } else {
      columns(name, array.data, nullptr, hedon::extent(shape_, size.rows, 1), width);
      if (name == "food_stock") foods();
    }
  }

  const std::vector<int32_t>& slots_with(Extent rows) const {
    if (rows == Extent::network_slots) return extent_.networks;
    return rows == Extent::learner_slots ? extent_.learners : extent_.slots;
  }

  /// Rows of numbers, or each field of rows of structs.
  template <class T>
  void columns(const std::string& name, T* first, const int32_t* index, int64_t count, int64_t width) {
    if constexpr (std::is_same_v<T, ObservationLine>) {
      // Only in rollouts.
    } else if constexpr (std::is_arithmetic_v<T>) {
      const int64_t stride = (width == 0 ? 1 : width) * static_cast<int64_t>(sizeof(T));
      visit_(name, SavedRows<T>{first, stride, index, count, width});
    } else if constexpr (std::is_same_v<T, Species>) {
      // It follows from the genome.
    } else {
      T::for_each_field([&](const char* field, auto member) {
        using Number = std::remove_cvref_t<decltype(first->*member)>;
        if (std::is_same_v<T, WorldHead> && strncmp(field, "death_log", 9) == 0) return;  // it concerns only the reader
        visit_(name + "." + field, SavedRows<Number>{&(first->*member), sizeof(T), index, count, 0});
      });
    }
  }

  template <class T>
  void by_slot(const std::string& name, const Array<T>& array, int64_t width, const std::vector<int32_t>& slots) {
    columns(name, array.data, slots.data(), static_cast<int64_t>(slots.size()), width);
    if (name == "resident_slot") by_slot("free." + name, array, width, extent_.free);
  }

  /// With late inheritance, the next newborns use the networks and genomes that the dead have left in free slots.
  void free_slots() {
    if (shape_.networks) by_slot("free.params", state_.params, shape_.params, extent_.free_networks);
    by_slot("free.genome", state_.genome, shape_.genes, extent_.free);
  }

  void foods() {
    const int64_t present = static_cast<int64_t>(extent_.foods.size());
    columns("food.x", state_.physics.circles.x.data, extent_.foods.data(), present, 0);
    columns("food.y", state_.physics.circles.y.data, extent_.foods.data(), present, 0);
  }

  void bodies() {
    BodyState::for_each_field([&](const char* name, auto member) {
      by_slot(std::string("body.") + name, state_.physics.bodies.*member, 0, extent_.slots);
    });
  }

  /// The rows of the window so far, for the agents that will learn from it.
  template <class T>
  void rollout(const std::string& name, const Array<T>& array, int64_t width) {
    if (extent_.filled == 0 || !shape_.learning) return;
    using Number = std::conditional_t<std::is_same_v<T, ObservationLine>, uint8_t, T>;
    const int64_t numbers = sizeof(T) / sizeof(Number);
    // One more observation than steps; two actions per step.
    const int64_t per_step = width / shape_.rollout;
    visit_(name, SavedRows<Number>{reinterpret_cast<Number*>(array.data), width * static_cast<int64_t>(sizeof(T)),
                                   extent_.learners.data(), extent_.taught, extent_.filled * per_step * numbers});
  }

  const WorldState& state_;
  const WorldShape& shape_;
  const SavedExtent& extent_;
  Visit& visit_;
};

template <class Visit>
void for_each_saved(const World& world, const SavedExtent& extent, Visit&& visit) {
  SavedArrays<Visit>(world, extent, visit).all();
}

/// The type of an array's numbers.
template <class T>
constexpr NumberKind kind_of() {
  if (std::is_floating_point_v<T>) return NumberKind::real;
  return std::is_signed_v<T> ? NumberKind::integer : NumberKind::natural;
}

/// An array of a checkpoint, without values.
inline SavedArray make_saved(SavedHead head) {
  const size_t bytes = head.length();
  std::unique_ptr<char[]> held(new char[bytes]);  // written by the caller
  const std::span<const char> all(held.get(), bytes);
  return {std::move(head), all, std::move(held)};
}

/// Names of the pairs of the three kinds, and of their impulses.
inline constexpr const char* PAIR_NAMES[] = {"pair.body", "pair.circle", "pair.wall"};
inline constexpr const char* IMPULSE_NAMES[] = {"impulse.body", "impulse.circle", "impulse.wall"};

}  // namespace hedon
