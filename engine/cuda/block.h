/// The threads of a CUDA block as the group for which every step rule is written: see `base/team.h`.
#pragma once

#include <cstring>

#include "cuda/block_crew.h"
#include "cuda/stage.h"
#include "cuda/tile.h"
#include "learning/network.h"

namespace hedon {

/// Floats of shared memory that each tile needs to sense and act: the two hidden layers of its agent.
inline constexpr int SENSE_FLOATS = 2 * HIDDEN;

/// The first float of shared memory behind them.
inline constexpr int64_t STAGE_FIRST = int64_t{BLOCK_THREADS} / TILE * SENSE_FLOATS;

/// One member of a block; all of them call the same functions.
class Block {
 public:
  HEDON_INLINE int rank() const { return thread_rank(); }
  HEDON_INLINE int size() const { return thread_count(); }
  HEDON_INLINE void barrier() const { block_barrier(); }
  HEDON_INLINE int tile() const { return thread_rank() / TILE; }
  HEDON_INLINE int tiles() const { return thread_count() / TILE; }

  /// Calls body(i) for i in [0, count), neighbors in neighboring threads.
  template <class Body>
  HEDON_INLINE void for_each(int count, Body&& body) const {
    each(count, body);
    barrier();
  }

  /// The same without a barrier at the end.
  template <class Body>
  HEDON_INLINE void each(int count, Body&& body) const {
    for (int i = rank(); i < count; i += size()) body(i);
  }

  /// Calls body(i) for i in [0, count), each time with a whole tile.
  template <class Body>
  HEDON_INLINE void for_each_by_tile(int count, Body&& body) const {
    for (int i = tile(); i < count; i += tiles()) body(i);
    barrier();
  }

  /// Calls body(crew, i) for i in [0, count), each time with a whole tile. The two tiles of a warp would wait for each
  /// other when they diverge, so no warp gets a second piece before all have one.
  template <class Body>
  HEDON_INLINE void for_each_by_crew(int count, Body&& body) const {
    for (int i = tile() / 2 + tile() % 2 * (tiles() / 2); i < count; i += tiles()) body(Tile{}, i);
    barrier();
  }

  /// Calls body(crew) with all threads as one crew.
  template <class Body>
  HEDON_INLINE void together(Body&& body) const {
    body(BlockCrew{});
    barrier();
  }

  template <class Body>
  HEDON_INLINE void once(Body&& body) const {
    if (rank() == 0) body();
    barrier();
  }

  /// The scratch memory of a step, of which some variants keep what fits in shared memory: see `stage.h`.
  HEDON_INLINE const PhysicsScratch& stage(const PhysicsScratch& scratch, const NeighborList& list) const {
    if constexpr (VARIANT.staged == 0) return scratch;
    constexpr int words = sizeof(PhysicsScratch) / sizeof(float);
    float* const memory = shared_memory() + STAGE_FIRST;
    const char* const pointers = reinterpret_cast<const char*>(&scratch);
    for_each(words, [&](int i) { memcpy(memory + i, pointers + i * sizeof(float), sizeof(float)); });
    PhysicsScratch& moved = *reinterpret_cast<PhysicsScratch*>(memory);
    once([&] { move_to_shared(moved, list, memory + words, VARIANT.staged); });
    return moved;
  }

  /// Calls body() on one thread of the tile while the others wait.
  template <class Body>
  HEDON_INLINE void once_by_tile(Body&& body) const {
    if (thread_lane() == 0) body();
    tile_barrier();
  }
};

}  // namespace hedon
