/// Queries about what is near an agent. `hedon.config.schema.neighbor` documents each number.
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

/// Answers one query about the agent in `slot` at the start of a step, from the scene: foods just eaten count if they
/// are seen. Ties go to the oldest agent, then to the first food.
HEDON_FN Answer ask_neighbors(const World& world, int32_t slot, const NeighborQuery& query, Vec2 forward) {
  const RayScene& scene = world.scene;
  const int32_t own = scene.own[slot];
  const Vec2 center{scene.x[own], scene.y[own]};
  int32_t count = 0, kin = 0, oldest = INT32_MAX;
  float least = query.range * query.range;
  Vec2 nearest{};
  for_each_circle_in(world, center, query.range, [&](int32_t i) {
    const Vec2 apart = Vec2{scene.x[i], scene.y[i]} - center;
    const float squared = squared_length(apart);
    if (i == own || !asks_for(query, static_cast<int32_t>(scene.type[i])) || !(squared <= query.range * query.range))
      return;
    const int32_t other = scene.slot[i], id = other < 0 ? INT32_MAX : world.state.life[other].agent_id;
    if (other >= 0) kin += are_kin(world, slot, other);
    if (count++ > 0 && (squared > least || (squared == least && id >= oldest))) return;
    nearest = apart;
    least = squared;
    oldest = id;
  });
  if (count == 0) return {0, 0, static_cast<double>(query.range), 0.0};
  return {count, kin, sqrt(static_cast<double>(least)), atan2_double(cross(forward, nearest), dot(forward, nearest))};
}

/// Answers all queries about the agent in `slot`, for its channels. `forward` is its heading, a unit vector.
HEDON_FN void look_around(const World& world, int32_t slot, Vec2 forward) {
  const FixedList<NeighborQuery, MAX_QUERIES>& queries = world.species(slot).layout.neighbors;
  for (int32_t q = 0; q < queries.count; ++q)
    world.scratch.near[int64_t{slot} * world.shape->near + q] = ask_neighbors(world, slot, queries[q], forward);
}

/// The answer to query `q` about the agent in `slot`.
HEDON_FN const Answer& answer(const World& world, int32_t slot, int32_t q) {
  return world.scratch.near[int64_t{slot} * world.shape->near + q];
}

/// The number of meals eaten in a step by the living agents that match a query at its end.
HEDON_FN int32_t count_meals_near(const World& world, int32_t slot, const NeighborQuery& query) {
  const BodyState& body = world.state.physics.bodies;
  int32_t count = 0;
  for_each_body_near(world.state.physics, body.x[slot], body.y[slot], query.range, [&](int32_t other) {
    if (other == slot || world.state.alive[other] == 0 || !asks_for(query, world.shape->species_of(other))) return;
    const Vec2 apart{body.x[other] - body.x[slot], body.y[other] - body.y[slot]};
    if (!(squared_length(apart) <= query.range * query.range)) return;
    for (int32_t m = 0; m < world.shape->meals(); ++m) count += world.meal(other)[m];
  });
  return count;
}

}  // namespace hedon
