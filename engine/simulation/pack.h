/// Worlds as one string of bytes: a mark, a hash of what follows, a text of the caller's, and the checkpoint of each
/// world with its seed. All lengths and numbers take eight bytes, in the order of this processor.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "simulation/checkpoint.h"

namespace hedon {

inline constexpr char PACK_MARK[] = {'h', 'e', 'd', 'o', 'n', '-', 'w', '1'};

/// What a string of bytes holds; views of it.
struct Packed {
  std::string complaint;  ///< "", or why it is no such string
  std::string_view head;
  std::vector<SavedWorld> worlds;
};

/// Reads a string of bytes, which may come from anyone. What the arrays hold, `Simulation::restore` checks.
/// hashed   whether to look for damage by the hash, which takes as long as a copy
Packed unpack(std::string_view bytes, bool hashed);

}  // namespace hedon
