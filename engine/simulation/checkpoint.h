/// A world as named arrays of plain numbers: everything that determines its future, and nothing else.
///
/// Agents are in the order of their ids, so that a checkpoint does not depend on their slots. Data that can be
/// recomputed is omitted: grids, the neighbor list (except its impulses), data derived from networks, and rollouts of
/// agents that will not learn from them. So two worlds with equal checkpoints have equal futures, bit for bit, and the
/// digest of the checkpoint is the digest of the world.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hedon {

enum class NumberKind : int32_t { integer, natural, real };  ///< signed, unsigned, floating

/// What one array of a checkpoint is; its numbers are in C order.
struct SavedHead {
  std::string name;
  NumberKind kind;
  int32_t size;  ///< bytes of one number
  std::vector<int64_t> shape;

  size_t length() const {
    size_t all = static_cast<size_t>(size);
    for (const int64_t length : shape) all *= static_cast<size_t>(length);
    return all;
  }
};

struct SavedArray : SavedHead {
  std::span<const char> bytes;   ///< in `held`, or in memory of the caller
  std::unique_ptr<char[]> held;  ///< null if the memory is the caller's
};

using Checkpoint = std::vector<SavedArray>;

/// Receives the arrays of a checkpoint in turn, each in pieces, so that no array has to be in memory as a whole. Once
/// it has returned false, it gets nothing more.
struct CheckpointSink {
  std::function<bool(const SavedHead&)> begin;
  std::function<bool(std::span<const char>)> piece;
};

/// A checkpoint with data that its reader needs, although the world's future does not: the seed and the slots of
/// agents.
struct SavedWorld {
  uint64_t seed;
  std::span<const char>
      slots;  ///< int32_t each: of the living in the order of their ids, then free ones as `free_slots`
  Checkpoint arrays;
};

}  // namespace hedon
