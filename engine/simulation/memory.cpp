#include "simulation/memory.h"

#include <cstdlib>

#include "base/platform.h"

namespace hedon {

Memory::Memory(int64_t bytes) : size_(bytes) {
  block_ = reserve_pages(static_cast<size_t>(bytes + PAGE));
  if (block_ == nullptr) abort();
  const auto address = reinterpret_cast<uintptr_t>(block_);
  first_ = reinterpret_cast<char*>((address + PAGE - 1) / PAGE * PAGE);
}

Memory::~Memory() {
  if (block_ != nullptr) release_pages(block_, static_cast<size_t>(size_ + PAGE));
  if (file_ >= 0) close_file(file_);
}

int Memory::keep_in_file(int64_t first, const std::string& folder) {
  if (first >= size_) return 0;
  const int64_t file = back_with_file(first_ + first, static_cast<size_t>(size_ - first), folder.c_str());
  if (file < 0) return static_cast<int>(-file);
  in_file_ = first;
  file_ = file;
  return 0;
}

void Memory::forget(const void* from, int64_t bytes) {
  if (file_ < 0) return;
  const int64_t first = static_cast<const char*>(from) - first_ - in_file_;
  const int64_t begin = (first + SMALL_PAGE - 1) / SMALL_PAGE * SMALL_PAGE;
  const int64_t end = (first + bytes) / SMALL_PAGE * SMALL_PAGE;
  if (begin < end) forget_in_file(file_, begin, end - begin);
}

PhysicsCapacity world_physics_capacity(const World& world) {
  const Config& config = *world.config;
  const WorldShape& shape = *world.shape;
  return physics_capacity(shape.capacity, shape.foods, shape.walls, config.arena.width, config.arena.height,
                          shape.bodies, config.physics);
}

void set_counts(World& world, int members) {
  const WorldShape& shape = *world.shape;
  const auto set_extents = [&]<class Arrays>(Arrays& arrays) {
    Arrays::for_each_shape([&](const char*, auto member, ArrayShape size) {
      if constexpr (IsArray<std::remove_cvref_t<decltype(arrays.*member)>>::value)
        (arrays.*member).count = extent(shape, size.rows, members) * extent(shape, size.width, members);
    });
  };
  set_extents(world.state);
  set_extents(world.scratch);
  set_extents(world.scene);
  const PhysicsCapacity capacity = world_physics_capacity(world);
  const auto set_count = [](const char*, auto& array, int64_t count) { array.count = count; };
  visit_state(world.state.physics, capacity, set_count);
  visit_scratch(world.physics_scratch, capacity, set_count);
}

}  // namespace hedon
