/// Who works on one piece of a phase: here a member of a team, alone; in a CUDA block, a tile of threads
/// (`cuda/tile.h`).
///
/// All threads of a crew call the same functions, each of which ends with a barrier of the crew. A loop body writes
/// only data of its own index, so results do not depend on the size of the crew.
#pragma once

#include <cstdint>

#include "base/device.h"

namespace hedon {

class Alone {
 public:
  /// Calls body(i) for i in [first, last).
  template <class Body>
  HEDON_INLINE void each(int32_t first, int32_t last, Body&& body) const {
    for (int32_t i = first; i < last; ++i) body(i);
  }

  /// Calls body(i) for i in [0, count), one group of consecutive i after another. Within the last group that there may
  /// be, number `ordered`, each i waits for the one before it; within others, none does.
  /// start   of each group, and `count` behind them
  template <class Body>
  HEDON_INLINE void each_by_group(const int32_t*, int32_t count, int32_t, Body&& body) const {
    each(0, count, body);
  }

  /// Calls body(i) for i in [first, last). Only where follows(i) does i wait for i - 1.
  template <class Follows, class Body>
  HEDON_INLINE void each_in_runs(int32_t first, int32_t last, Follows&&, Body&& body) const {
    each(first, last, body);
  }

  /// Calls keep(n, i) for the n-th i in [first, last) for which holds(i), for each n; returns how many there are.
  /// What is kept for n may be overwritten until then: there must be room for as many as there are i.
  template <class Holds, class Keep>
  HEDON_INLINE int32_t select(int32_t first, int32_t last, Holds&& holds, Keep&& keep) const {
    int32_t count = 0;
    for (int32_t i = first; i < last; ++i) {
      const bool held = holds(i);
      keep(count, i);  // not only if it holds: a branch would often be mispredicted
      count += held;
    }
    return count;
  }

  /// Calls body() on one thread.
  template <class Body>
  HEDON_INLINE void once(Body&& body) const {
    body();
  }

  /// Whether it is true on any thread.
  HEDON_INLINE bool any(bool value) const { return value; }

  /// The largest value of any thread; none may be NaN.
  HEDON_INLINE float largest(float value) const { return value; }

  /// Sets bits of a word in which other threads may set bits at the same time.
  HEDON_INLINE void set_bits(uint64_t& word, uint64_t bits) const { word |= bits; }
};

}  // namespace hedon
