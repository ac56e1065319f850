/// The agents near an agent: queries of rules. `hedon.config.neighbor` says what each number is.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/math.h"
#include "physics/neighbor.h"
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

/// Answers one query about the agent in `slot`. Of equally near ones, the oldest is the nearest.
HEDON_FN void ask_neighbors(const World& world, int32_t slot, const NeighborQuery& query, double* answer) {
  const WorldState& state = world.state;
  const BodyState& body = state.physics.bodies;
  const Vec2 center{body.x[slot], body.y[slot]};
  int32_t count = 0, kin = 0, nearest = -1;
  float least = query.range * query.range;
  for_each_body_near(state.physics, center.x, center.y, query.range, [&](int32_t other) {
    if (other == slot || state.alive[other] == 0 || (query.species >> world.shape->species_of(other) & 1) == 0) return;
    const float squared = squared_length(Vec2{body.x[other], body.y[other]} - center);
    if (!(squared <= query.range * query.range)) return;
    ++count;
    kin += are_kin(world, slot, other);
    const bool older = nearest < 0 || state.life[other].agent_id < state.life[nearest].agent_id;
    if (squared > least || (squared == least && !older)) return;
    nearest = other;
    least = squared;
  });
  answer[0] = count;
  answer[1] = kin;
  answer[2] = sqrt(static_cast<double>(least));
  answer[3] = 0.0;
  if (nearest < 0) return;
  const Vec2 forward = heading(body.angle[slot]), apart = Vec2{body.x[nearest], body.y[nearest]} - center;
  answer[3] = atan2_double(cross(forward, apart), dot(forward, apart));
}

/// Answers all queries about the agent in `slot`, for the channels of its rules.
HEDON_FN void look_around(const World& world, int32_t slot) {
  const FixedList<NeighborQuery, MAX_QUERIES>& queries = world.species(slot).layout.neighbors;
  for (int32_t q = 0; q < queries.count; ++q)
    ask_neighbors(world, slot, queries[q], &world.scratch.near[int64_t{slot} * world.shape->near + q * QUERY_NUMBERS]);
}

}  // namespace hedon
