#include "simulation/checkpoint.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/hash.h"
#include "simulation/pack.h"
#include "simulation/saved.h"
#include "simulation/simulation.h"

namespace hedon {
namespace {

SavedExtent extent_of(const World& world) {
  const WorldState& state = world.state;
  const WorldHead& head = world.head();
  SavedExtent extent{};
  extent.slots.assign(state.living.data, state.living.data + head.living_count);
  extent.free = free_slots(world);
  extent.eaten_foods = head.eaten_food_count;
  extent.newborns = state.newborn.count > 0 ? head.births_in_window : 0;
  for (int32_t f = 0; f < world.shape->foods; ++f) {
    if (state.physics.circles.present[f]) extent.foods.push_back(f);
  }
  extent.filled = head.step % world.shape->steps;
  const int64_t window_start = head.step - extent.filled;
  list_networks(world, extent);
  for (const int32_t slot : extent.learners) extent.taught += state.life[slot].birth_step <= window_start;
  return extent;
}

template <class T>
SavedArray save_list(const std::string& name, const std::vector<T>& values, std::vector<int64_t> shape) {
  SavedArray array = make_saved({name, kind_of<T>(), static_cast<int32_t>(sizeof(T)), std::move(shape)});
  if (!values.empty()) memcpy(array.held.get(), values.data(), array.bytes.size());
  return array;
}

struct PairImpulse {
  int32_t first, second;
  float normal, tangent;

  bool operator<(const PairImpulse& other) const {
    return first != other.first ? first < other.first : second < other.second;
  }
};

/// Saves the pairs with impulses, sorted by the rank of the first body. A pair without impulse has no effect and is
/// omitted. find(second, &other) gives the saved name of a pair's second, or false if it no longer exists.
template <class Find, class Take>
void save_pairs(const World& world, const std::vector<int32_t>& rank, const PairList& list, int kind, Find&& find,
                Take&& take) {
  const NeighborList& neighbors = world.state.physics.neighbors;
  std::vector<PairImpulse> pairs;
  const int32_t count = list.start[neighbors.head[0].bodies];
  for (int32_t pair = 0; pair < count; ++pair) {
    PairImpulse found{rank[static_cast<size_t>(neighbors.slot[list.first[pair]])], 0, list.normal_impulse[pair],
                      list.tangent_impulse[pair]};
    const float zero[2] = {};
    // Compare bits, since a negative zero differs from the zero of a new pair.
    if (found.first < 0 || memcmp(&found.normal, zero, sizeof zero) == 0 || !find(list.second[pair], &found.second))
      continue;
    pairs.push_back(found);
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int32_t> who;
  std::vector<float> impulse;
  for (const PairImpulse& pair : pairs) {
    who.insert(who.end(), {pair.first, pair.second});
    impulse.insert(impulse.end(), {pair.normal, pair.tangent});
  }
  const int64_t rows = static_cast<int64_t>(pairs.size());
  take(save_list(PAIR_NAMES[kind], who, {rows, 2}));
  take(save_list(IMPULSE_NAMES[kind], impulse, {rows, 2}));
}

/// The place of each slot in the living order; -1 for the dead, and for newborns, which are in no list yet.
std::vector<int32_t> listed_ranks(const World& world, const SavedExtent& extent) {
  std::vector<int32_t> rank(static_cast<size_t>(world.shape->capacity), -1);
  for (size_t i = 0; i < extent.slots.size(); ++i) {
    const int32_t slot = extent.slots[i];
    if (world.state.life[slot].birth_step < world.head().step)
      rank[static_cast<size_t>(slot)] = static_cast<int32_t>(i);
  }
  return rank;
}

/// Calls take(SavedArray) for the arrays that `for_each_saved` does not cover: the places of foods, and the impulses.
template <class Take>
void save_lists(const World& world, const SavedExtent& extent, Take&& take) {
  take(save_list("food.slot", extent.foods, {static_cast<int64_t>(extent.foods.size())}));

  const NeighborList& list = world.state.physics.neighbors;
  const std::vector<int32_t> rank = listed_ranks(world, extent);
  const auto body = [&](int32_t index, int32_t* other) {
    *other = rank[static_cast<size_t>(list.slot[index])];
    return *other >= 0;
  };
  const auto circle = [&](int32_t food, int32_t* other) {
    *other = food;
    return world.state.physics.circles.present[food] != 0;
  };
  const auto wall = [](int32_t segment, int32_t* other) {
    *other = segment;
    return true;
  };
  save_pairs(world, rank, list.bodies, 0, body, take);
  save_pairs(world, rank, list.circles, 1, circle, take);
  save_pairs(world, rank, list.walls, 2, wall, take);
}

/// Approximate bytes of a piece of an array; several fit into a cache.
constexpr int64_t PIECE = int64_t{1} << 18;
/// A piece has a multiple of this many rows, so that all pieces but the last consist of whole eight-byte words.
constexpr int64_t PIECE_ROWS = 8;

/// Rows of at least this length may be in a file, and are prefetched shortly before they are read [byte].
constexpr int64_t LONG_ROW = 4096;

/// Passes all arrays of a checkpoint to a sink.
void save_each(const World& world, const Memory& memory, const CheckpointSink& sink) {
  const SavedExtent extent = extent_of(world);
  std::vector<char> room;
  bool going = true;
  for_each_saved(world, extent, [&]<class T>(const std::string& name, const SavedRows<T>& rows) {
    going = going && sink.begin({name, kind_of<T>(), static_cast<int32_t>(sizeof(T)), rows.shape()});
    const int64_t bytes = static_cast<int64_t>(rows.row_bytes());
    const int64_t most = std::max(PIECE / (PIECE_ROWS * std::max<int64_t>(bytes, 1)), int64_t{1}) * PIECE_ROWS;
    for (int64_t first = 0; first < rows.count && bytes > 0 && going; first += most) {
      const int64_t count = std::min(most, rows.count - first);
      room.resize(static_cast<size_t>(count * bytes));
      for (int64_t i = 0; i < count; ++i) {
        if (bytes >= LONG_ROW) memory.expect(rows.row(std::min(first + i + AHEAD, rows.count - 1)), bytes);
        memcpy(room.data() + i * bytes, rows.row(first + i), static_cast<size_t>(bytes));
      }
      going = sink.piece({room.data(), room.size()});
    }
  });
  save_lists(world, extent, [&](const SavedArray& array) {
    going = going && sink.begin(array) && (array.bytes.empty() || sink.piece(array.bytes));
  });
}

/// Counts the bytes of packed worlds, or writes them if there is a buffer.
class Packer {
 public:
  explicit Packer(char* at) : at_(at) {}

  size_t size() const { return size_; }
  void put(const void* from, size_t bytes) {
    if (at_ != nullptr) memcpy(at_ + size_, from, bytes);
    size_ += bytes;
  }
  void put(uint64_t number) { put(&number, sizeof number); }
  void text(std::string_view text) {
    put(text.size());
    put(text.data(), text.size());
    pad();
  }
  void head(const std::string& name, NumberKind kind, size_t size, const std::vector<int64_t>& shape) {
    text(name);
    put(static_cast<uint64_t>(kind));
    put(size);
    put(shape.size());
    put(shape.data(), shape.size() * sizeof(int64_t));
  }
  /// Rows, directly from the memory of the world.
  template <class T>
  void rows(const SavedRows<T>& rows) {
    const size_t bytes = rows.row_bytes();
    for (int64_t i = 0; i < rows.count && at_ != nullptr; ++i)
      memcpy(at_ + size_ + static_cast<size_t>(i) * bytes, rows.row(i), bytes);
    size_ += static_cast<size_t>(rows.count) * bytes;
    pad();
  }
  void pad() {
    const uint64_t zero = 0;
    put(&zero, (8 - size_ % 8) % 8);
  }

 private:
  char* at_;
  size_t size_ = 0;
};

void pack_world(const World& world, Packer& out) {
  const SavedExtent extent = extent_of(world);
  out.put(world.seed);
  std::vector<int32_t> slots = extent.slots;
  slots.insert(slots.end(), extent.free.begin(), extent.free.end());
  out.text({reinterpret_cast<const char*>(slots.data()), slots.size() * sizeof(int32_t)});
  for_each_saved(world, extent, [&]<class T>(const std::string& name, const SavedRows<T>& rows) {
    out.head(name, kind_of<T>(), sizeof(T), rows.shape());
    out.rows(rows);
  });
  save_lists(world, extent, [&](const SavedArray& array) {
    out.head(array.name, array.kind, static_cast<size_t>(array.size), array.shape);
    out.put(array.bytes.data(), array.bytes.size());
    out.pad();
  });
  out.text("");  // no more arrays
}

}  // namespace

void Simulation::save(int index, const CheckpointSink& sink) {
  save_each(complete(index), memory_[static_cast<size_t>(index)], sink);
}

Checkpoint Simulation::save(int index) {
  Checkpoint out;
  size_t filled = 0;
  const auto begin = [&](const SavedHead& head) {
    out.push_back(make_saved(head));
    filled = 0;
    return true;
  };
  const auto piece = [&](std::span<const char> bytes) {
    memcpy(out.back().held.get() + filled, bytes.data(), bytes.size());
    filled += bytes.size();
    return true;
  };
  save(index, {begin, piece});
  return out;
}

uint64_t Simulation::digest(int index) {
  Hash hash;
  const auto begin = [&](const SavedHead& head) {
    hash.mix(head.length());
    return true;
  };
  const auto piece = [&](std::span<const char> bytes) {
    hash.add_words(bytes.data(), bytes.size());
    return true;
  };
  save(index, {begin, piece});
  return hash.value();
}

size_t Simulation::pack(std::string_view head, char* out) {
  Packer packer(out);
  packer.put(PACK_MARK, sizeof PACK_MARK);
  packer.put(uint64_t{0});  // the hash of what follows
  const size_t hashed = packer.size();
  packer.text(head);
  packer.put(worlds_.size());
  for (int i = 0; i < world_count(); ++i) pack_world(complete(i), packer);
  if (out == nullptr) return packer.size();
  const uint64_t hash = hash_bytes(out + hashed, packer.size() - hashed);
  memcpy(out + hashed - sizeof hash, &hash, sizeof hash);
  return packer.size();
}

}  // namespace hedon
