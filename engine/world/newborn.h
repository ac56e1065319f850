/// Newborns that inherit only at the end of the window, as in the paper's released code. Until then they act with the
/// network, and are rewarded by the genome, of the previous agent in their slot. See "What `released` changes" in
/// docs/model.md.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "evolution/genome.h"
#include "learning/init.h"
#include "world/expression.h"
#include "world/world.h"

namespace hedon {

/// Resets the optimizer of a slot. If no agent has learned there since the world was made, the moments are 0 already,
/// and their memory is not touched.
HEDON_FN void forget_updates(World& world, int32_t slot) {
  const WorldState& state = world.state;
  if (!world.species(slot).learns || state.updates[slot] == 0) return;
  const int32_t size = world.species(slot).network.size();
  const int64_t first = int64_t{slot} * world.shape->params;
  for (int32_t p = 0; p < size; ++p) state.first_moment[first + p] = state.second_moment[first + p] = 0.0f;
  state.updates[slot] = 0;
}

/// Gives the agent in `slot` a new network and the optimizer that belongs to it, if its species has networks.
HEDON_FN void give_network(World& world, int32_t slot, const RandomStream& random) {
  if (!world.species(slot).has_network) return;
  const NetworkShape& network = world.species(slot).network;
  init_network(network, random, world.params(slot));
  world.kernel->network.pack_weights(network, world.network(slot));
  forget_updates(world, slot);
}

/// Stores the initial network of a new agent, if it will be passed on.
HEDON_FN void keep_initial(const World& world, int32_t slot) {
  const Species& species = world.species(slot);
  if (!species.learns || species.config.birth.network != BirthNetwork::initial) return;
  for (int32_t p = 0; p < species.network.size(); ++p) world.initial_params(slot)[p] = world.params(slot)[p];
}

/// Makes the network of an agent that has learned nothing.
HEDON_FN void give_own_network(World& world, int32_t slot) {
  const uint32_t id = static_cast<uint32_t>(world.state.life[slot].agent_id);
  give_network(world, slot, RandomStream{world.seed, Purpose::network, id, 0});
  keep_initial(world, slot);
}

/// Makes the network of a child: a new one, or its parent's current or initial one with noise.
HEDON_FN void give_child_network(World& world, int32_t parent, int32_t slot) {
  const Species& species = world.species(parent);
  const BirthConfig& birth = species.config.birth;
  if (!species.has_network || birth.network == BirthNetwork::none) return give_own_network(world, slot);
  const bool kept = species.learns && birth.network == BirthNetwork::initial;
  const float* from = kept ? world.initial_params(parent) : world.params(parent);
  const uint32_t id = static_cast<uint32_t>(world.state.life[slot].agent_id);
  DrawSequence draws{RandomStream{world.seed, Purpose::inherited_network, id, 0}, 0};
  const int32_t size = species.network.size();
  for (int32_t p = 0; p < size; p += 4) {
    float noise[4];
    draws.normal(4, noise);
    for (int32_t i = 0; i < 4 && p + i < size; ++i)
      world.params(slot)[p + i] = from[p + i] + birth.network_noise * noise[i];
  }
  world.kernel->network.pack_weights(species.network, world.network(slot));
  forget_updates(world, slot);
  keep_initial(world, slot);
}

HEDON_FN bool inherits_late(const World& world) {
  return world.config->world.inheritance == WorldInheritance::at_window_end;
}

/// Puts a network and a genome into every free slot of a new world, for the newborns that come first.
HEDON_FN void fill_vacancies(World& world) {
  uint32_t number = 0;
  for (int32_t s = 0; s < world.shape->species; ++s) {
    const Species& species = world.shape->of[s];
    for (int32_t i = 0; i < world.state.free_count[s]; ++i, ++number) {
      const int32_t slot = world.state.free[species.first_slot + i];
      give_network(world, slot, RandomStream{world.seed, Purpose::vacant_network, number, 0});
      init_genome(species.layout, RandomStream{world.seed, Purpose::vacant_genome, number, 0}, world.genome(slot));
      express_genes(world, slot);
    }
  }
}

HEDON_FN float* newborn_genome(const World& world, int32_t index) {
  return &world.state.newborn_genome[int64_t{index} * world.shape->genes];
}

/// Records the parent of the newest agent until the window ends.
HEDON_FN void note_newborn(World& world, int32_t parent, int32_t child_id) {
  const WorldState& state = world.state;
  const int32_t at = world.head().births_in_window;
  if (at >= world.shape->newborns) return world.fail(Status::birth_overflow, child_id, at);
  const Life& life = state.life[parent];
  Newborn& newborn = state.newborn[at] = {child_id, -1};
  if (state.newborn_species.count > 0) state.newborn_species[at] = world.shape->species_of(parent);
  const bool young = life.birth_step > world.window_start();
  // A young parent gets its own genome only when the window ends. Entries past the end of a genome are always 0.
  for (int32_t g = 0; g < world.shape->genes; ++g)
    newborn_genome(world, at)[g] = young ? 0.0f : world.genome(parent)[g];
  if (!young) return;
  for (newborn.parent = at - 1; state.newborn[newborn.parent].agent_id != life.agent_id;) --newborn.parent;
}

/// Gives the newborns of a window, in the order of their births, their genomes, and those that still live their
/// networks. A newborn that has become a parent passes on the genome that it gets here.
HEDON_FN void apply_late_inheritance(World& world) {
  const WorldState& state = world.state;
  const WorldHead& head = world.head();
  const int32_t births = head.births_in_window;
  for (int32_t i = 0; i < births; ++i) {
    const Newborn& newborn = state.newborn[i];
    const float* parent = newborn_genome(world, newborn.parent < 0 ? i : newborn.parent);
    const int32_t species = state.newborn_species.count > 0 ? state.newborn_species[i] : 0;
    inherit(world.shape->of[species].layout, world.config->world.mutation_noise, world.seed,
            static_cast<uint32_t>(newborn.agent_id), {static_cast<uint32_t>(births), static_cast<uint32_t>(i)}, parent,
            newborn_genome(world, i));
  }
  // Both lists are in the order of ids, and the newborns are the youngest of the living.
  for (int32_t i = births - 1, at = head.living_count - 1; i >= 0 && at >= 0; --i) {
    const int32_t slot = state.living[at];
    if (state.life[slot].agent_id != state.newborn[i].agent_id) continue;  // it has died
    for (int32_t g = 0; g < world.shape->genes; ++g) world.genome(slot)[g] = newborn_genome(world, i)[g];
    give_own_network(world, slot);
    express_genes(world, slot);
    --at;
  }
}

/// Begins a window: records which slots are taken, and sets the count of births to 0.
HEDON_FN void open_window(World& world) {
  WorldHead& head = world.head();
  head.births_before = head.births_in_window;
  head.births_in_window = 0;
  if (world.config->world.parents == WorldParents::all) return;
  for (int32_t slot = 0; slot < world.shape->capacity; ++slot)
    world.state.resident_slot[slot] = world.state.alive[slot];
}

/// Whether the agent in `slot` may have children in this window.
HEDON_FN bool may_breed(const World& world, int32_t slot) {
  return world.config->world.parents == WorldParents::all || world.state.resident_slot[slot] != 0;
}

}  // namespace hedon
