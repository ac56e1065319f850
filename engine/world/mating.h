/// Two parents: an agent that drew a birth waits some time for a second such agent nearby.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "physics/neighbor.h"
#include "world/world.h"

namespace hedon {

HEDON_FN bool needs_mate(const World& world, int32_t slot) {
  return world.species(slot).config.birth.mating == BirthMating::pairs;
}

/// Makes the agent in `slot` wait for a second parent from this step on.
HEDON_FN void await_mate(const World& world, int32_t slot) {
  world.state.ready_until[slot] = world.head().step + world.species(slot).config.birth.mating_window;
}

/// The nearest waiting agent of the same species within range; the oldest of equally near ones; -1 if there is none.
HEDON_FN int32_t find_mate(const World& world, int32_t slot) {
  const WorldState& state = world.state;
  const BodyState& body = state.physics.bodies;
  const Species& species = world.species(slot);
  const float widest = world.shape->bodies.largest[world.shape->species_of(slot)].radius;
  int32_t best = -1;
  float nearest = 0.0f;
  const float most = species.body.radius + widest + species.config.birth.mating_range;
  for_each_body_near(state.physics, body.x[slot], body.y[slot], most, [&](int32_t other) {
    const bool waits = other != slot && state.alive[other] != 0 && other >= species.first_slot &&
                       other < species.last_slot && state.ready_until[other] >= world.head().step &&
                       world.scratch.starved[other] == 0;
    const Vec2 apart{body.x[other] - body.x[slot], body.y[other] - body.y[slot]};
    const float squared = squared_length(apart);
    if (!waits) return;
    const float reach = species.body.radius + world.species(other).body.radius + species.config.birth.mating_range;
    if (!(squared <= reach * reach) || (best >= 0 && squared > nearest)) return;
    const bool older = best >= 0 && state.life[other].agent_id < state.life[best].agent_id;
    if (best >= 0 && squared == nearest && !older) return;
    best = other;
    nearest = squared;
  });
  return best;
}

/// Ends the waiting of two parents.
HEDON_FN void end_waiting(const World& world, int32_t slot, int32_t mate) {
  world.state.ready_until[slot] = world.state.ready_until[mate] = -1;
}

/// Draws each gene of a child from one of its parents, before mutation.
HEDON_FN void recombine(const World& world, uint32_t child_id, int32_t parent, int32_t mate, float* genome) {
  const RandomStream random{world.seed, Purpose::recombination, child_id, 0};
  for (int32_t g = 0; g < world.species(parent).layout.genes.count; ++g) {
    const bool first = (random.draw(static_cast<uint32_t>(g)).word[0] >> 31) == 0;
    genome[g] = world.genome(first ? parent : mate)[g];
  }
}

}  // namespace hedon
