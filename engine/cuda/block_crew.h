/// A whole block as the crew that works on a phase: see `base/crew.h`.
#pragma once

#include "cuda/thread.h"

namespace hedon {

class BlockCrew {
 public:
  template <class Body>
  HEDON_INLINE void each(int32_t first, int32_t last, Body&& body) const {
    for (int32_t i = first + thread_rank(); i < last; i += thread_count()) body(i);
    block_barrier();
  }

  template <class Body>
  HEDON_INLINE void once(Body&& body) const {
    if (thread_rank() == 0) body();
    block_barrier();
  }

  template <class Holds, class Keep>
  HEDON_INLINE int32_t select(int32_t first, int32_t last, Holds&& holds, Keep&& keep) const {
    const auto held = [&](int32_t i) -> int32_t { return holds(first + i); };
    return each_behind(last - first, held, [&](int32_t i, int32_t n, int32_t size) {
      if (size > 0) keep(n, first + i);
    });
  }

  template <class Holds>
  HEDON_INLINE bool any_of(int32_t count, Holds&& holds) const {
    bool held = false;
    for (int32_t i = thread_rank(); i < count; i += thread_count()) held = held || holds(i);
    int32_t all;
    sum_before(held, all);
    return all > 0;
  }

  template <class Find, class Keep, class Done>
  HEDON_INLINE int32_t collect(int32_t count, Find&& find, Keep&& keep, Done&& done) const {
    const auto size = [&](int32_t i) {
      int32_t found = 0;
      find(i, [&](int32_t) { ++found; });
      return found;
    };
    return each_behind(count, size, [&](int32_t i, int32_t first, int32_t) {
      int32_t n = first;
      find(i, [&](int32_t value) { keep(n++, i, value); });
      done(i, first, n);
    });
  }

  template <class Key, class Place>
  HEDON_INLINE void sort(int32_t count, int32_t keys, int32_t* start, int32_t* work, Key&& key, Place&& place) const {
    each(0, keys, [&](int32_t k) { start[k] = -1; });
    link(count, keys, start, work, key);
    const auto size = [&](int32_t k) {
      int32_t items = 0;
      for (int32_t i = start[k]; i >= 0; i = work[i]) ++items;
      return items;
    };
    const int32_t all = each_behind(keys, size, [&](int32_t k, int32_t first, int32_t) {
      int32_t at = first;
      for (int32_t i = start[k]; i >= 0; i = work[i]) place(i, at++, k);
      start[k] = first;
    });
    once([&] { start[keys] = all; });
  }

 private:
  /// Links the i of each key to a list, in ascending order: head[k] is the first, -1 on entry; next[i], -1 at the end.
  template <class Key>
  HEDON_INLINE void link(int32_t count, int32_t keys, int32_t* head, int32_t* next, Key&& key) const {
    each(0, count, [&](int32_t i) {
      const int32_t k = key(i);
      if (k >= 0) next[i] = thread_exchange(head[k], i);
    });
    // They arrived in arbitrary order.
    each(0, keys, [&](int32_t k) {
      int32_t left = head[k];
      head[k] = -1;
      while (left >= 0) {
        const int32_t one = left;
        left = next[one];
        int32_t* at = &head[k];
        while (*at >= 0 && *at < one) at = &next[*at];
        next[one] = *at;
        *at = one;
      }
    });
  }

  /// Calls body(i, n, size(i)) for i in [0, count), where n is the sum of size(j) over all j < i; returns the sum over
  /// all.
  template <class Size, class Body>
  HEDON_INLINE int32_t each_behind(int32_t count, Size&& size, Body&& body) const {
    int32_t total = 0;
    for (int32_t from = 0; from < count; from += thread_count()) {
      const int32_t i = from + thread_rank();
      int32_t all;
      const int32_t own = i < count ? size(i) : 0;
      const int32_t before = sum_before(own, all);
      if (i < count) body(i, total + before, own);
      total += all;
    }
    block_barrier();
    return total;
  }

  /// The sum of the values of all threads before this one; `all` becomes the sum of all threads.
  HEDON_INLINE int32_t sum_before(int32_t value, int32_t& all) const {
    int32_t sum = value;
    for (int step = 1; step < TILE; step *= 2) {
      const int32_t other = tile_read_count(sum, (thread_lane() - step) & (TILE - 1));
      if (thread_lane() >= step) sum += other;
    }
    int32_t* const of_tile = reinterpret_cast<int32_t*>(shared_memory());
    const int32_t tile = thread_rank() / TILE;
    if (thread_lane() == TILE - 1) of_tile[tile] = sum;
    block_barrier();
    int32_t before = 0;
    all = 0;
    for (int32_t other = 0; other < thread_count() / TILE; ++other) {
      before += other < tile ? of_tile[other] : 0;
      all += of_tile[other];
    }
    block_barrier();  // all threads have read the values, so they may be overwritten
    return before + sum - value;
  }
};

}  // namespace hedon
