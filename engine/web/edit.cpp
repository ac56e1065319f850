#include "web/edit.h"

#include "world/population.h"
#include "world/step.h"

namespace hedon {
namespace {

const char* const NO_PLACE = "there is no room: something is in the way there, or it is not within the walls";

/// The item nearest to a place, among items whose reach includes the place; -1 for none.
class Nearest {
 public:
  explicit Nearest(Vec2 position) : position_(position) {}

  void look(int32_t item, float x, float y, float reach) {
    const float distance = squared_length(Vec2{x, y} - position_);
    if (distance > reach * reach || (found_ >= 0 && distance >= best_)) return;
    found_ = item;
    best_ = distance;
  }

  int32_t found() const { return found_; }

 private:
  Vec2 position_;
  int32_t found_ = -1;
  float best_ = 0.0f;
};

std::string add_agent(World& world, int32_t species, Vec2 position) {
  const SpeciesConfig& config = world.shape->of[species].config;
  if (inherits_late(world))
    return "agents cannot be added if children inherit at the end of a window, as with the fidelity \"released\"";
  if (world.state.free_count[species] == 0)
    return "there is no room: population.capacity is " + std::to_string(world.shape->of[species].capacity());
  if (!can_place(world, position, founder_radius(world, species, world.head().next_agent_id))) return NO_PLACE;
  const float angle = child_heading(world, static_cast<uint32_t>(world.head().next_agent_id));
  spawn_founder(world, species, position, angle, config.energy.initial, world.head().step);
  world.head().extinct_step = -1;
  return "";
}

std::string add_food(World& world, int32_t kind, Vec2 position) {
  FoodStock& stock = world.state.food_stock[kind];
  const int32_t capacity = world.config->food[kind].capacity;
  if (stock.present >= capacity) return "there is no room: the capacity of this food is " + std::to_string(capacity);
  if (!can_place(world, position, world.config->world.food_radius)) return NO_PLACE;
  place_food(world, kind, position);
  stock.number = stock.number + 1.0 < capacity ? stock.number + 1.0 : capacity;
  return "";
}

std::string remove_agent(World& world, int32_t slot) {
  const WorldState& state = world.state;
  WorldHead& head = world.head();
  if (head.death_log_count >= world.shape->death_log_rows) return "too many deaths wait to be read";
  world.scratch.starved[slot] = 0;
  if (world.shape->hunting) world.scratch.eaten[slot] = 0;
  kill(world, slot);
  state.death_log[head.death_log_count - 1].death_step = head.step;
  int32_t kept = 0;
  for (int32_t i = 0; i < head.living_count; ++i) {
    if (state.living[i] != slot) state.living[kept++] = state.living[i];
  }
  head.living_count = kept;
  if (kept == 0) head.extinct_step = head.step;
  return "";
}

std::string remove_food(World& world, int32_t food) {
  WorldState& state = world.state;
  FoodStock& stock = state.food_stock[food_kind(*world.shape, food)];
  state.physics.circles.present[food] = 0;
  remove(state.physics.circle_grid, food);
  mark_stale(state.physics);
  stock.present -= 1;
  stock.number -= 1.0;
  return "";
}

/// Prepares the next step if something has changed.
std::string settle(World& world, std::string refused) {
  if (refused.empty()) prepare_step(Alone{}, world);
  return refused;
}

}  // namespace

std::string add_thing(World& world, int32_t type, Vec2 position) {
  const int32_t species = world.shape->species;
  if (type < 0 || type >= species + world.shape->kinds) return "there is no such species or food";
  return settle(world, type < species ? add_agent(world, type, position) : add_food(world, type - species, position));
}

std::string remove_thing(World& world, Vec2 position, float slack) {
  Nearest agents(position), foods(position);
  const BodyState& body = world.state.physics.bodies;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = world.state.living[i];
    agents.look(slot, body.x[slot], body.y[slot], world.species(slot).body.radius + slack);
  }
  if (agents.found() >= 0) return settle(world, remove_agent(world, agents.found()));
  const auto& circles = world.state.physics.circles;
  for (int32_t f = 0; f < world.shape->foods; ++f) {
    if (circles.present[f] != 0) foods.look(f, circles.x[f], circles.y[f], world.config->world.food_radius + slack);
  }
  return foods.found() < 0 ? "there is nothing to remove" : settle(world, remove_food(world, foods.found()));
}

}  // namespace hedon
