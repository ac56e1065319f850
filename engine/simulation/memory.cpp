#include "simulation/memory.h"

namespace hedon {

void set_counts(World& world) {
  const WorldShape& shape = *world.shape;
  const int64_t slots = shape.slots, kinds = shape.kinds, genes = shape.genome.size(), params = shape.network.size();
  const int64_t rows = slots * shape.steps;

  WorldState& state = world.state;
  state.clock.count = state.fault.count = state.counters.count = 1;
  state.alive.count = state.living.count = state.free.count = state.life.count = state.touch.count = slots;
  state.eaten.count = slots * kinds;
  state.genome.count = slots * genes;
  set_counts(state.physics, shape.slots, shape.foods, shape.walls);
  state.physics.circles.x.count = state.physics.circles.y.count = state.physics.circles.present.count = shape.foods;
  state.food_stock.count = kinds;
  state.params.count = state.first_moment.count = state.second_moment.count = slots * params;
  state.folded_bias.count = slots * HIDDEN;
  state.updates.count = slots;
  state.observation.count = rows + slots;
  state.action.count = rows * ACTIONS;
  state.log_prob.count = state.value.count = state.reward.count = rows;
  state.event.count = shape.events;
  state.event_eaten.count = shape.events * kinds;
  state.event_genome.count = shape.events * genes;

  set_counts(world.physics_scratch, shape.slots, shape.foods, shape.walls);

  for_each_array(world.scratch, "", [&](const std::string&, auto& array) { array.count = slots; });
  world.scratch.meal.count = slots * kinds;
  world.scratch.eater.count = world.scratch.eater_distance.count = shape.foods;

  world.scene.x.count = world.scene.y.count = world.scene.radius.count = world.scene.type.count = slots + shape.foods;
}

}  // namespace hedon
