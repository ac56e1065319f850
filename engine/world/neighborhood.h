/// What is near an agent: queries. `hedon.config.neighbor` says what each number is.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "physics/neighbor.h"
#include "world/scene.h"
#include "world/world.h"

namespace hedon {

/// Whether two agents share a parent, or one is a parent of the other. Founders have none.
HEDON_FN bool are_kin(const World& world, int32_t slot, int32_t other) {
  const WorldState& state = world.state;
  const int32_t id = state.life[slot].agent_id, other_id = state.life[other].agent_id;
  const int32_t parents[] = {state.life[slot].parent_id, world.shape->mating ? state.mate_id[slot] : -1};
  const int32_t others[] = {state.life[other].parent_id, world.shape->mating ? state.mate_id[other] : -1};
  for (const int32_t parent : parents) {
    if (parent >= 0 && (parent == other_id || parent == others[0] || parent == others[1])) return true;
  }
  return others[0] == id || others[1] == id;
}

/// Whether a query finds things of a type.
HEDON_FN bool asks_for(const NeighborQuery& query, int32_t type) { return (query.types >> type & 1) != 0; }

/// Calls f(other, apart) for the other living agents that a query finds around the agent in `slot`.
template <class F>
HEDON_FN void for_each_agent_near(const World& world, int32_t slot, const NeighborQuery& query, F&& f) {
  const BodyState& body = world.state.physics.bodies;
  const Vec2 center{body.x[slot], body.y[slot]};
  for_each_body_near(world.state.physics, center.x, center.y, query.range, [&](int32_t other) {
    if (other == slot || world.state.alive[other] == 0 || !asks_for(query, world.shape->species_of(other))) return;
    const Vec2 apart = Vec2{body.x[other], body.y[other]} - center;
    if (squared_length(apart) <= query.range * query.range) f(other, apart);
  });
}

/// Calls f(apart) for the foods that a query finds around the agent in `slot`, with those just eaten if they are seen.
template <class F>
HEDON_FN void for_each_food_near(const World& world, int32_t slot, const NeighborQuery& query, F&& f) {
  const RayScene& scene = world.scene;
  const Vec2 center{world.state.physics.bodies.x[slot], world.state.physics.bodies.y[slot]};
  for_each_circle_in(world, center, query.range, [&](int32_t i) {
    const int32_t type = static_cast<int32_t>(scene.type[i]);
    if (type < world.shape->species || !asks_for(query, type)) return;
    const Vec2 apart = Vec2{scene.x[i], scene.y[i]} - center;
    if (squared_length(apart) <= query.range * query.range) f(apart);
  });
}

/// Answers one query about the agent in `slot` as a step begins. Of equally near agents, the oldest is the nearest.
HEDON_FN void ask_neighbors(const World& world, int32_t slot, const NeighborQuery& query, Vec2 forward,
                            double* answer) {
  const WorldState& state = world.state;
  int32_t count = 0, kin = 0, oldest = -1;
  float least = query.range * query.range;
  Vec2 nearest{};
  const auto find = [&](Vec2 apart, int32_t id) {
    const float squared = squared_length(apart);
    if (count++ > 0 && (squared > least || (squared == least && !(id < oldest)))) return;
    nearest = apart;
    least = squared;
    oldest = id;
  };
  for_each_agent_near(world, slot, query, [&](int32_t other, Vec2 apart) {
    kin += are_kin(world, slot, other);
    find(apart, state.life[other].agent_id);
  });
  if (query.types >> world.shape->species != 0)
    for_each_food_near(world, slot, query, [&](Vec2 apart) { find(apart, INT32_MAX); });
  answer[0] = count;
  answer[1] = kin;
  answer[2] = count > 0 ? sqrt(static_cast<double>(least)) : static_cast<double>(query.range);
  answer[3] = count > 0 ? atan2_double(cross(forward, nearest), dot(forward, nearest)) : 0.0;
}

/// Answers all queries about the agent in `slot`, for its channels. `forward` is its heading, a unit vector.
HEDON_FN void look_around(const World& world, int32_t slot, Vec2 forward) {
  const FixedList<NeighborQuery, MAX_QUERIES>& queries = world.species(slot).layout.neighbors;
  double* answers = &world.scratch.near[int64_t{slot} * world.shape->near];
  for (int32_t q = 0; q < queries.count; ++q)
    ask_neighbors(world, slot, queries[q], forward, answers + q * QUERY_NUMBERS);
}

/// What the agents that a query finds when a step is done ate in it, in meals.
HEDON_FN int32_t count_meals_near(const World& world, int32_t slot, const NeighborQuery& query) {
  int32_t count = 0;
  for_each_agent_near(world, slot, query, [&](int32_t other, Vec2) {
    for (int32_t m = 0; m < world.shape->meals(); ++m) count += world.meal(other)[m];
  });
  return count;
}

}  // namespace hedon
