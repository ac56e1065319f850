/// A world as named arrays of plain numbers: everything that decides its future, and nothing else.
///
/// Agents are in the order of their ids, so that a checkpoint does not depend on their slots. Data that can be computed
/// again is left out: grids, the neighbor list (except its impulses), data derived from networks, and rollouts of
/// agents that will not learn from them. So two worlds with equal checkpoints have equal futures, bit for bit, and the
/// digest of the checkpoint is the digest of the world.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hedon {

enum class NumberKind : int32_t { integer, natural, real };  ///< signed, unsigned, floating

/// One array of a checkpoint, in C order.
struct SavedArray {
  std::string name;
  NumberKind kind;
  int32_t size;  ///< bytes of one number
  std::vector<int64_t> shape;
  std::vector<char> bytes;
};

using Checkpoint = std::vector<SavedArray>;

}  // namespace hedon
