/// Worlds as one byte string: a mark, a hash of the rest, a text of the caller's, and the checkpoint and seed of each
/// world. All lengths and numbers take eight bytes, in the byte order of this processor.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "simulation/checkpoint.h"

namespace hedon {

inline constexpr char PACK_MARK[] = {'h', 'e', 'd', 'o', 'n', '-', 'w', '1'};

/// The contents of a byte string, as views of it.
struct Packed {
  std::string complaint;  ///< "", or why the string is invalid
  std::string_view head;
  std::vector<SavedWorld> worlds;
};

/// Reads a byte string from an untrusted source. `Simulation::restore` checks the contents of the arrays.
/// hashed   whether to check for damage with the hash, which takes as long as a copy
Packed unpack(std::string_view bytes, bool hashed);

}  // namespace hedon
