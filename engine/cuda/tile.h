/// A tile of 16 threads as the crew that works on one piece of a phase: see `base/crew.h`.
#pragma once

#include "cuda/thread.h"

namespace hedon {

class Tile {
 public:
  template <class Body>
  HEDON_INLINE void each(int32_t first, int32_t last, Body&& body) const {
    for (int32_t i = first + thread_lane(); i < last; i += TILE) body(i);
    tile_barrier();
  }

  template <class Body>
  HEDON_INLINE void each_by_group(const int32_t* start, int32_t count, int32_t ordered, Body&& body) const {
    for (int32_t group = 0, from = 0; from < count; ++group) {
      const int32_t to = start[group + 1];
      if (group < ordered)
        each(from, to, body);
      else
        once([&] {
          for (int32_t i = from; i < to; ++i) body(i);
        });
      from = to;
    }
  }

  template <class Follows, class Body>
  HEDON_INLINE void each_in_runs(int32_t first, int32_t last, Follows&& follows, Body&& body) const {
    each(first, last, [&](int32_t i) {
      if (i > first && follows(i)) return;
      do {
        body(i);
      } while (++i < last && follows(i));
    });
  }

  template <class Holds, class Keep>
  HEDON_INLINE int32_t select(int32_t first, int32_t last, Holds&& holds, Keep&& keep) const {
    const uint32_t before = (1u << thread_lane()) - 1u;
    int32_t count = 0;
    for (int32_t from = first; from < last; from += TILE) {
      const int32_t i = from + thread_lane();
      const bool held = i < last && holds(i);
      const uint32_t all = tile_ballot(held);
      if (held) keep(count + count_bits(all & before), i);
      count += count_bits(all);
    }
    tile_barrier();
    return count;
  }

  template <class Body>
  HEDON_INLINE void once(Body&& body) const {
    if (thread_lane() == 0) body();
    tile_barrier();
  }

  HEDON_INLINE bool any(bool value) const { return tile_ballot(value) != 0; }

  HEDON_INLINE float largest(float value) const {
    for (int half = TILE / 2; half > 0; half /= 2) {
      const float other = tile_read(value, thread_lane() ^ half);
      value = other > value ? other : value;
    }
    return value;
  }

  HEDON_INLINE void set_bits(uint64_t& word, uint64_t bits) const { thread_set_bits(word, bits); }
};

}  // namespace hedon
