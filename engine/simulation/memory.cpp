#include "simulation/memory.h"

#include <sys/mman.h>

#include <cstdlib>

namespace hedon {

Memory::Memory(int64_t bytes) : size_(bytes) {
  const size_t reserved = static_cast<size_t>(bytes + PAGE);
  block_ = mmap(nullptr, reserved, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (block_ == MAP_FAILED) abort();
  const auto address = reinterpret_cast<uintptr_t>(block_);
  first_ = reinterpret_cast<char*>((address + PAGE - 1) / PAGE * PAGE);
#if defined(MADV_HUGEPAGE)
  madvise(first_, static_cast<size_t>(bytes), MADV_HUGEPAGE);  // a hint: without it, everything works, but slower
#endif
}

Memory::~Memory() {
  if (block_ != nullptr) munmap(block_, static_cast<size_t>(size_ + PAGE));
}

PhysicsCapacity world_physics_capacity(const World& world) {
  const WorldConfig& config = *world.config;
  const WorldShape& shape = *world.shape;
  return physics_capacity(shape.capacity, shape.foods, shape.walls, config.arena.width, config.arena.height,
                          world.constants->body, config.physics);
}

void set_counts(World& world, int members) {
  const WorldShape& shape = *world.shape;
  const int64_t capacity = shape.capacity, kinds = shape.kinds, genes = shape.genome.size(),
                params = shape.network.size();
  const int64_t rows = capacity * shape.steps;

  WorldState& state = world.state;
  state.head.count = state.fault.count = state.counters.count = 1;
  state.alive.count = state.living.count = state.free.count = state.life.count = state.touch.count = capacity;
  state.eaten.count = capacity * kinds;
  state.genome.count = capacity * genes;
  const PhysicsCapacity physics = world_physics_capacity(world);
  const auto set_count = [](const char*, auto& array, int64_t count) { array.count = count; };
  visit_state(state.physics, physics, set_count);
  visit_scratch(world.physics_scratch, physics, set_count);
  state.physics.circles.x.count = state.physics.circles.y.count = state.physics.circles.present.count = shape.foods;
  state.food_stock.count = kinds;
  state.ghost.count = world.config->sensor.eaten_food == EatenFood::seen ? shape.foods : 0;
  state.old_slot.count = world.config->birth.parents == Parents::old_slots ? capacity : 0;
  state.newborn.count = shape.newborns;
  state.newborn_genome.count = shape.newborns * genes;
  state.params.count = state.first_moment.count = state.second_moment.count = capacity * params;
  state.folded_bias.count = capacity * HIDDEN;
  const bool rounded = world.config->learning.acting_weights == ActingWeights::bfloat16;
  state.packed_weights.count = rounded ? capacity * shape.network.pairs() : 0;
  state.updates.count = capacity;
  state.observation.count = rows + capacity;
  state.action.count = rows * ACTIONS;
  state.log_prob.count = state.value.count = state.reward.count = rows;
  state.event.count = shape.events;
  state.event_eaten.count = shape.events * kinds;
  state.event_genome.count = shape.events * genes;

  for_each_array(world.scratch, "", [&](const std::string&, auto& array) { array.count = capacity; });
  world.scratch.meal.count = capacity * kinds;
  world.scratch.eater.count = world.scratch.eater_distance.count = shape.foods;

  RayScene& scene = world.scene;
  const int64_t circles = shape.circles;
  scene.x.count = scene.y.count = scene.radius.count = scene.type.count = scene.cell.count = circles;
  scene.start.count = int64_t{shape.scene.columns} * shape.scene.rows + 1;
  scene.own.count = capacity;
  scene.wall_ax.count = scene.wall_ay.count = scene.wall_bx.count = scene.wall_by.count = shape.walls;
  scene.candidates.count = members * RAY_ARCS * (circles + 16);
}

}  // namespace hedon
