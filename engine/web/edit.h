/// Changes of a world by hand, between two steps: somebody or something is put into it, or taken out of it.
///
/// Who is added is as a founder is: with a new network, a genome drawn for its id, and a founder's energy, which the
/// ledger counts as such. Who is taken out has died of age and energy, as far as records say. The world then goes on
/// by its own rules, but it is no longer what its config and seed give.
#pragma once

#include <cstdint>
#include <string>

#include "world/world.h"

namespace hedon {

/// Adds a thing of a type, counted as the senses do: first the species, then the kinds of food. Returns "", or why
/// there is no room for it; then nothing has changed.
std::string add_thing(World& world, int32_t type, Vec2 position);

/// Takes out the agent whose body is at a place, or else the food there, with `slack` beyond their rims. Returns "", or
/// what is wrong.
std::string remove_thing(World& world, Vec2 position, float slack);

}  // namespace hedon
