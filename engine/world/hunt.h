/// Agents that eat agents: which claims they have, and which of these are met.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "world/world.h"

namespace hedon {

/// The claims of a step: each eater has one, on the nearest agent at its mouth, or one on every such agent.
struct Claims {
  const StepScratch& scratch;
  bool every;
  int32_t count = 0;

  HEDON_FN void add(int32_t eater, int32_t prey, float distance) {
    int32_t at = every ? -1 : scratch.claim_of[eater];
    if (at < 0) {
      at = scratch.claim_of[eater] = count++;
    } else if (scratch.claim_distance[at] <= distance) {
      return;
    }
    scratch.claim_eater[at] = eater;
    scratch.claim_prey[at] = prey;
    scratch.claim_distance[at] = distance;
  }

  HEDON_FN void remove(int32_t at) {
    --count;
    scratch.claim_eater[at] = scratch.claim_eater[count];
    scratch.claim_prey[at] = scratch.claim_prey[count];
  }

  /// Whether some eater has a claim on this agent.
  HEDON_FN bool is_claimed(int32_t slot) const {
    for (int32_t i = 0; i < count; ++i) {
      if (scratch.claim_prey[i] == slot) return true;
    }
    return false;
  }
};

/// The random number that orders agents when the order matters. Ties within a step are possible only by chance.
HEDON_FN uint32_t hunt_draw(const World& world, int32_t slot) {
  const RandomStream random{world.seed, Purpose::hunt, static_cast<uint32_t>(world.state.life[slot].agent_id),
                            static_cast<uint32_t>(world.head().step)};
  return random.draw(0).word[0];
}

/// Collects claims from the contacts of the step: each mouth that touches prey has one, unless its owner is digesting.
HEDON_FN Claims find_claims(const World& world) {
  const WorldState& state = world.state;
  const BodyState& body = state.physics.bodies;
  const NeighborList& list = state.physics.neighbors;
  Claims claims{world.scratch, world.config->world.prey_at_mouth == WorldPreyAtMouth::all};
  for (int32_t i = 0; i < world.head().living_count; ++i) world.scratch.claim_of[state.living[i]] = -1;
  for (int32_t pair = 0; pair < list.bodies.start[list.head[0].bodies]; ++pair) {
    const uint8_t mark = list.bodies.mark[pair];
    if (mark == 0) continue;
    const int32_t a = list.slot[list.bodies.first[pair]], b = list.slot[list.bodies.second[pair]];
    const Vec2 apart{body.x[b] - body.x[a], body.y[b] - body.y[a]};
    if ((mark & FIRST) != 0 && state.digestion[a] == 0) claims.add(a, b, squared_length(apart));
    if ((mark & SECOND) != 0 && state.digestion[b] == 0) claims.add(b, a, squared_length(apart));
  }
  return claims;
}

/// Whether claim `a` precedes claim `b` in the order of the ids of eaters, then of prey.
HEDON_FN bool comes_before(const World& world, int32_t a, int32_t b) {
  const StepScratch& scratch = world.scratch;
  const auto id = [&](int32_t slot) { return world.state.life[slot].agent_id; };
  const int32_t first = id(scratch.claim_eater[a]), second = id(scratch.claim_eater[b]);
  return first < second || (first == second && id(scratch.claim_prey[a]) < id(scratch.claim_prey[b]));
}

/// The claim that is settled next: the one with the smallest draw among the eaters that no other claims, or among all
/// if every eater is claimed.
HEDON_FN int32_t next_claim(const World& world, const Claims& claims) {
  const StepScratch& scratch = world.scratch;
  for (const bool only_free : {true, false}) {
    int32_t best = -1;
    uint32_t least = 0;
    for (int32_t i = 0; i < claims.count; ++i) {
      if (only_free && claims.is_claimed(scratch.claim_eater[i])) continue;
      const uint32_t draw = hunt_draw(world, scratch.claim_eater[i]);
      if (best < 0 || draw < least || (draw == least && comes_before(world, i, best))) {
        best = i;
        least = draw;
      }
    }
    if (best >= 0) return best;
  }
  return -1;
}

/// An eater's gain from its prey: its share of the energy that the prey has left, or had before the step.
HEDON_FN double gain_by(const World& world, int32_t eater, int32_t prey) {
  const float share = world.species(eater).layout.eats_species[world.shape->species_of(prey)];
  const bool before = world.config->world.prey_energy == WorldPreyEnergy::before_step;
  return static_cast<double>(share) * (before ? world.held_before(prey)[ENERGY] : world.state.life[prey].energy);
}

/// Gives an eater its gain from its prey.
HEDON_FN void feed_with(World& world, int32_t eater, int32_t prey, double gained) {
  const SpeciesConfig& config = world.species(eater).config;
  const int32_t s = world.shape->species_of(prey);
  Life& life = world.state.life[eater];
  const double wanted = life.energy + gained, capacity = config.energy.capacity;
  world.scratch.energy_capped[eater] += wanted > capacity ? wanted - capacity : 0.0;
  world.state.hunt_counters[world.shape->species_of(eater)].energy_hunted += gained;
  life.energy = wanted > capacity ? capacity : wanted;
  life.energy_gained += gained;
  const int32_t meal = world.shape->kinds + s;
  world.meal(eater)[meal] += 1;
  world.state.eaten[int64_t{eater} * world.shape->meals() + meal] += 1;
  world.state.digestion[eater] = config.diet.digestion_steps;
}

/// Settles claims if only one eater gets each prey. An agent that is eaten eats nothing, so its own prey stays alive;
/// an agent that eats is not eaten, even if another agent of a cycle claims it.
HEDON_FN void settle_one_by_one(World& world, Claims& claims) {
  const StepScratch& scratch = world.scratch;
  while (claims.count > 0) {
    const int32_t at = next_claim(world, claims);
    const int32_t eater = scratch.claim_eater[at], prey = scratch.claim_prey[at];
    scratch.eaten[prey] = 1;
    feed_with(world, eater, prey, gain_by(world, eater, prey));
    for (int32_t i = claims.count - 1; i >= 0; --i) {
      const int32_t wanted = scratch.claim_prey[i];
      if (wanted == prey || wanted == eater || scratch.claim_eater[i] == prey) claims.remove(i);
    }
  }
}

/// Sorts claims by `comes_before`, so that the sum of an eater's gains does not depend on the order of contacts.
HEDON_FN void sort_claims(const World& world, const Claims& claims) {
  const StepScratch& scratch = world.scratch;
  const auto swap = [](int32_t& a, int32_t& b) {
    const int32_t kept = a;
    a = b;
    b = kept;
  };
  for (int32_t i = 1; i < claims.count; ++i) {
    for (int32_t at = i; at > 0 && comes_before(world, at, at - 1); --at) {
      swap(scratch.claim_eater[at], scratch.claim_eater[at - 1]);
      swap(scratch.claim_prey[at], scratch.claim_prey[at - 1]);
    }
  }
}

/// Settles claims if all of them are met. All are based on what agents have before any of them eats, so the order does
/// not matter. An agent that is eaten eats too, and dies with what it has gained.
HEDON_FN void settle_all_at_once(World& world, const Claims& claims) {
  const StepScratch& scratch = world.scratch;
  sort_claims(world, claims);
  for (int32_t i = 0; i < claims.count; ++i) {
    scratch.eaten[scratch.claim_prey[i]] = 1;
    scratch.claim_gain[i] = gain_by(world, scratch.claim_eater[i], scratch.claim_prey[i]);
  }
  for (int32_t i = 0; i < claims.count; ++i)
    feed_with(world, scratch.claim_eater[i], scratch.claim_prey[i], scratch.claim_gain[i]);
}

/// Settles all claims of this step. An agent that starves in this step neither eats nor is eaten. If several agents
/// claim the same prey, either one of them gets it, by a draw, or each gets it in full.
HEDON_FN void hunt(World& world) {
  const StepScratch& scratch = world.scratch;
  const WorldState& state = world.state;
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    const int32_t slot = state.living[i];
    scratch.eaten[slot] = 0;
  }
  Claims claims = find_claims(world);
  for (int32_t i = claims.count - 1; i >= 0; --i) {
    if (scratch.starved[scratch.claim_eater[i]] != 0 || scratch.starved[scratch.claim_prey[i]] != 0) claims.remove(i);
  }
  for (int32_t i = 0; i < world.head().living_count; ++i) {
    int32_t& clock = state.digestion[state.living[i]];
    if (clock > 0) --clock;
  }
  if (world.config->world.prey_sharing == WorldPreySharing::each) return settle_all_at_once(world, claims);
  settle_one_by_one(world, claims);
}

}  // namespace hedon
