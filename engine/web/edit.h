/// Edits of a world by hand, between two steps: adding and removing agents and foods.
///
/// An added agent is like a founder: it has a new network, a genome drawn for its id, and a founder's energy, which the
/// ledger counts as such. In records, a removed agent counts as dead of age and energy. The world then continues
/// under its own rules, but can no longer be reproduced from its config and seed.
#pragma once

#include <cstdint>
#include <string>

#include "world/world.h"

namespace hedon {

/// Adds an agent or a food of a type, numbered as in the senses: first the species, then the kinds of food. Returns "",
/// or why there is no room for it; then nothing has changed.
std::string add_thing(World& world, int32_t type, Vec2 position);

/// Removes the agent whose body is at a place, or else the food there, with a tolerance of `slack` beyond their rims.
/// Returns "", or what is wrong.
std::string remove_thing(World& world, Vec2 position, float slack);

}  // namespace hedon
