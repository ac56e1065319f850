/// The crew that works on one piece of a phase: here a single member of a team. In a CUDA block, a tile of threads
/// works on each of several pieces (`cuda/tile.h`), and all threads on a single one (`cuda/block_crew.h`).
///
/// All threads of a crew call the same functions, each of which ends with a barrier of the crew. A loop body writes
/// only data of its own index, so results do not depend on the size of the crew.
#pragma once

#include <cstdint>

#include "base/device.h"

namespace hedon {

/// One thread. Tiles have the functions as far as `set_bits`; whole blocks `each`, `once`, `select` and those after it.
class Alone {
 public:
  /// Calls body(i) for i in [first, last).
  template <class Body>
  HEDON_INLINE void each(int32_t first, int32_t last, Body&& body) const {
    for (int32_t i = first; i < last; ++i) body(i);
  }

  /// Calls body() on one thread.
  template <class Body>
  HEDON_INLINE void once(Body&& body) const {
    body();
  }

  /// Calls body(i) for i in [0, count), one group of consecutive i after another. Within the group with number
  /// `ordered`, the last one if it exists, each i waits for the one before it; within the others, none does. The first
  /// argument is the start of each group, and `count` behind them.
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

  /// Whether the value is true on any thread.
  HEDON_INLINE bool any(bool value) const { return value; }

  /// The largest value of any thread; none may be NaN.
  HEDON_INLINE float largest(float value) const { return value; }

  /// Sets bits of a word in which other threads may set bits at the same time.
  HEDON_INLINE void set_bits(uint64_t& word, uint64_t bits) const { word |= bits; }

  /// Whether holds(i) is true for any i in [0, count).
  template <class Holds>
  HEDON_INLINE bool any_of(int32_t count, Holds&& holds) const {
    for (int32_t i = 0; i < count; ++i) {
      if (holds(i)) return true;
    }
    return false;
  }

  /// Calls keep(n, i, value) for the n-th value that find(i, add) adds, for i in [0, count) in order, and then
  /// done(i, first, last) with the range of n of an i; returns how many there are. `find` may be called twice.
  template <class Find, class Keep, class Done>
  HEDON_INLINE int32_t collect(int32_t count, Find&& find, Keep&& keep, Done&& done) const {
    int32_t n = 0;
    for (int32_t i = 0; i < count; ++i) {
      const int32_t first = n;
      find(i, [&](int32_t value) { keep(n++, i, value); });
      done(i, first, n);
    }
    return n;
  }

  /// Sorts by key: calls place(i, at, key) for each i in [0, count) that has one. Equal ones keep their order.
  /// start    (keys + 1) becomes the first place of each key, and the number of all
  /// work     (count); key(i) may read from work[i]
  /// key(i)   in [0, keys), or -1 for none; called once
  template <class Key, class Place>
  HEDON_INLINE void sort(int32_t count, int32_t keys, int32_t* start, int32_t* work, Key&& key, Place&& place) const {
    for (int32_t k = 0; k < keys; ++k) start[k] = 0;
    for (int32_t i = 0; i < count; ++i) {
      const int32_t k = work[i] = key(i);
      if (k >= 0) ++start[k];
    }
    int32_t sum = 0;
    for (int32_t k = 0; k < keys; ++k) start[k] = sum += start[k];
    start[keys] = sum;
    for (int32_t i = count - 1; i >= 0; --i) {
      const int32_t k = work[i];
      if (k >= 0) place(i, --start[k], k);
    }
  }
};

}  // namespace hedon
